#include "config/substrate_proposal.hpp"

#include <fmt/format.h>

#include "config/values.hpp"

namespace thawslide::config {

namespace {

// Bed in the polygons of a substrate, as comments, since a case has one bed and most slides entrain none.
std::string bed_in_comments(const std::string& outline) {
  return fmt::format(
      R"(# An erodible bed in these polygons: remove the first # of each line below. All values are assumed.
# [bed]
# law = "momentum"
# outline = {}
# depth = 1.0  # m, at most grid.cell; {{ attribute = "depth" }}: of each polygon
# strength = 1.0e3  # Pa, without load
# friction_angle = 6.0  # degrees; the bed resists if its tangent exceeds the friction coefficient above
# depth_per_slip = 0.1  # m of bed per m of slip, at most
# material = "rock_ice"
# temperature = -5.0  # C
# porosity = 0.375  # volume fraction of ice and water
)",
      quoted(outline));
}

}  // namespace

std::string substrate_tables(const Outlines& outlines) {
  std::string text;
  for (const ProposedSubstrate& each : proposed_substrates) {
    if (const auto outline = outlines.find(each.name); outline != outlines.end()) {
      text += fmt::format(R"(
[substrate.{}]
outline = {}
friction = "coefficient"  # a fraction of the normal stress; it contains the pore pressure
friction_coefficient = {}  # assumed: {} to {}
)",
                          each.name, quoted(outline->second), each.coefficient, each.low, each.high);
      text += each.can_be_entrained ? bed_in_comments(outline->second) : "";
    }
  }
  return text;
}

std::string substrate_ranges(const Outlines& outlines) {
  std::string text;
  for (const ProposedSubstrate& each : proposed_substrates) {
    if (outlines.count(each.name) > 0) {
      text +=
          fmt::format("# Fraction of the normal stress. Assumed.\n\"substrate.{}.friction_coefficient\" = [{}, {}]\n",
                      each.name, each.low, each.high);
    }
  }
  return text;
}

}  // namespace thawslide::config
