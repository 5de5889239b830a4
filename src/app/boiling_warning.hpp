// What a run says where the base gets too hot to be believed.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// Notes where water would boil and does not, or band columns are hot or have boiled dry; each once.
class BoilingWatch {
 public:
  // What is to be told now; empty where nothing is.
  template <int Dim>
  std::string warning(const sim::Simulation<Dim, double>& simulation);

 private:
  bool is_hot_ = false, is_dry_ = false;  // has been told
};

}  // namespace thawslide::app
