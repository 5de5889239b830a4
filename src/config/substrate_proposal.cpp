#include "config/substrate_proposal.hpp"

#include <fmt/format.h>

#include "config/values.hpp"

namespace thawslide::config {

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
