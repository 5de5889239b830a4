// Numbers with few digits, for messages. A bound that is rounded to the nearest such number may be on the wrong side of
// the exact one: a user who follows the advice would be refused again.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace thawslide {

// What digit of a number above 0 counts last, where so many count.
inline double last_digit(double number, int digits) {
  return std::pow(10.0, std::floor(std::log10(number)) - (digits - 1));
}

// The smallest number of so many digits that is at least the given one, which is above 0; round-off is no more.
inline double rounded_up(double number, int digits) {
  const double digit = last_digit(number, digits);
  return std::ceil(number / digit * (1.0 - 1e-12)) * digit;
}

// The largest number of so many digits that is at most the given one, which is above 0; round-off is no less.
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

}  // namespace thawslide
