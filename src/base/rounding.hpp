// Numbers with few digits, for messages. Rounding a bound to nearest could give a value on the wrong side of it, which
// the program would refuse again.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace thawslide {

// Unit of the last of a number of significant digits. number: above 0.
inline double last_digit(double number, int digits) {
  return std::pow(10.0, std::floor(std::log10(number)) - (digits - 1));
}

// Smallest number with this many significant digits that is at least the given one, up to round-off. number: above 0.
inline double rounded_up(double number, int digits) {
  const double digit = last_digit(number, digits);
  return std::ceil(number / digit * (1.0 - 1e-12)) * digit;
}

// Largest number with this many significant digits that is at most the given one, up to round-off. number: above 0.
inline double rounded_down(double number, int digits) {
  const double digit = last_digit(number, digits);
  return std::floor(number / digit * (1.0 + 1e-12)) * digit;
}

// Formats a number of at least 1 with this number of significant digits, without decimals, with commas between
// thousands: "10,000".
inline std::string with_commas(double number, int digits) {
  const double digit = std::max(1.0, last_digit(number, digits));
  std::string text = fmt::format("{:.0f}", std::round(number / digit) * digit);
  for (std::size_t place = text.size(); place > 3;) {
    place -= 3;
    text.insert(place, ",");
  }
  return text;
}

// Formats a number with this number of significant digits: "0.012", "-1.5", "84,000"; never in scientific notation from
// 0.001 on.
inline std::string with_digits(double number, int digits) {
  if (!(std::abs(number) >= 1000.0) || !std::isfinite(number)) {
    return fmt::format("{:.{}g}", number, std::max(digits, std::abs(number) >= 100.0 ? 3 : 1));
  }
  return (number < 0.0 ? "-" : "") + with_commas(std::abs(number), digits);
}

}  // namespace thawslide
