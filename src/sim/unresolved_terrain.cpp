#include "sim/unresolved_terrain.hpp"

#include <fmt/format.h>

#include "base/instances.hpp"
#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

// Text such as "x = 120 m, y = 350 m".
template <int Dim>
std::string place_text(double x, double y) {
  const std::string text = fmt::format("x = {} m", coordinate_text(x));
  return Dim == 2 ? text : text + fmt::format(", y = {} m", coordinate_text(y));
}

}  // namespace

template <int Dim>
std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<Dim>& simulation) {
  const Model<Dim>& model = simulation.model();
  const config::Grid& grid = simulation.parameters().grid;
  if (!model.following) {
    return {};
  }
  std::vector<std::string> warnings;
  if (const auto& lowering = model.following->lowering(); lowering.columns > 0) {
    warnings.push_back(fmt::format(
        "grid.steepest: the terrain is steeper than {:g} degrees. Columns of nodes lowered: {}, by up to {} m at {}. "
        "Increase grid.steepest (allowed: up to 85 degrees) to keep the terrain, with shorter steps, or filter it.",
        grid.steepest, count_text(static_cast<double>(lowering.columns)), rounded_text(lowering.largest, 2),
        place_text<Dim>(lowering.place[0] + model.origin[0], lowering.place[Dim - 2] + model.origin[Dim - 2])));
  }
  return warnings;
}

#define THAWSLIDE_INSTANTIATE(Dim) \
  template std::vector<std::string> warnings_of_unresolved_terrain<Dim>(const Simulation<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
