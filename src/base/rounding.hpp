// Bounds in few digits. One that is rounded to the nearest number of few digits may lie on the wrong side of itself,
// and who follows the advice is refused again.
#pragma once

#include <cmath>

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

}  // namespace thawslide
