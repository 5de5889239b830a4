// Cell sizes that divide the domain into a whole number along each axis, for advice that can be applied directly.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

inline constexpr double fewest_cells = 2.0;  // of the domain along each axis

// Removes the round-off of a product from a number for a file or a message.
[[nodiscard]] inline double tidy(double number) { return std::stod(fmt::format("{:.12g}", number)); }

// Largest number of one or two digits (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten) that is at most x.
[[nodiscard]] double round_down(double x);

// Extent of the domain along each axis [m].
[[nodiscard]] std::vector<double> lengths_of_domain(const Case& parameters);

// Cell of at most this size that divides each length into a whole number, as `cell` does. Without lengths any cell
// fits, and one of few digits is returned.
[[nodiscard]] double fitting_cell(double most, double cell, const std::vector<double>& lengths);

// Cell of at least this size that divides each length into a whole number, as `cell` does; `least` itself if there is
// none.
[[nodiscard]] double fitting_cell_from(double least, double cell, const std::vector<double>& lengths);

// Cell close to `cell`, which itself need not fit, that divides each length into a whole number of at least two; 0 if
// there is none.
[[nodiscard]] double fitting_cell_near(double cell, const std::vector<double>& lengths);

}  // namespace thawslide::config
