// Large numbers for people: "10,000".
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rounding.hpp"

namespace thawslide {

// A number of 1 or more with so many significant digits, without decimals, and with commas between thousands.
inline std::string with_commas(double number, int digits) {
  const double digit = std::max(1.0, last_digit(number, digits));
  std::string text = fmt::format("{:.0f}", std::round(number / digit) * digit);
  for (std::size_t place = text.size(); place > 3;) {
    place -= 3;
    text.insert(place, ",");
  }
  return text;
}

}  // namespace thawslide
