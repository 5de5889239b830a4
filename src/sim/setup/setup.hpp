// Case of a simulation and all that follows from it before the first step.
#pragma once

#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

template <int Dim>
struct Setup {
  config::Case parameters;
  config::Site site;  // contents of its map files
  Model<Dim> model;

  [[nodiscard]] double cell() const { return parameters.grid.cell; }  // mesh size [m]
  [[nodiscard]] bool is_adaptive() const { return parameters.time.stepping == config::Stepping::adaptive; }
  // Prescribed band thickness [m].
  [[nodiscard]] double band_thickness(double time) const { return parameters.band.thickness.at(time); }
};

}  // namespace thawslide::sim
