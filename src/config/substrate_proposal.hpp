// Substrates of a new case: polygons of ground for which `thawslide new` has an option.
#pragma once

#include <array>
#include <map>
#include <string>

namespace thawslide::config {

// Name of the table [substrate.NAME], option of `new`, and friction coefficient with its range. All are assumptions:
// these coefficients contain the pore pressure of events.
struct ProposedSubstrate {
  const char *name, *option;
  double coefficient, low, high;
  bool can_be_entrained;  // the case then contains an erodible bed as comments
};
inline constexpr std::array<ProposedSubstrate, 3> proposed_substrates{
    {{"glacier", "--glacier", 0.1, 0.05, 0.15, false},
     {"snow", "--snow", 0.15, 0.05, 0.25, false},
     {"valley_floor", "--valley-floor", 0.2, 0.1, 0.3, true}}};

// Files of polygons, as named in the case, by the names of proposed substrates.
using Outlines = std::map<std::string, std::string>;

// Tables of a case file.
[[nodiscard]] std::string substrate_tables(const Outlines& outlines);

// Ranges of a sweep file, in its table [sweep.range].
[[nodiscard]] std::string substrate_ranges(const Outlines& outlines);

}  // namespace thawslide::config
