// Cells of which a domain has a whole number along each axis, for advice that can be followed as it stands.
#pragma once

#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Largest number of one or two digits (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten) that is at most x.
[[nodiscard]] double round_down(double x);

// The extent of the domain along each axis [m].
[[nodiscard]] std::vector<double> lengths_of_domain(const Case& parameters);

// A cell of at most so much, of which a domain of these lengths has a whole number along each axis, as it has of
// `cell`. No lengths: any cell fits, and one of few digits is taken.
[[nodiscard]] double fitting_cell(double most, double cell, const std::vector<double>& lengths);

// A cell of at least so much, of which a domain of these lengths has a whole number along each axis, as it has of
// `cell`; `least` itself where there is none.
[[nodiscard]] double fitting_cell_from(double least, double cell, const std::vector<double>& lengths);

// A cell about as large as `cell`, which itself need not fit, of which a domain of these lengths has a whole number
// along each axis, two or more; 0 where there is none.
[[nodiscard]] double fitting_cell_near(double cell, const std::vector<double>& lengths);

}  // namespace thawslide::config
