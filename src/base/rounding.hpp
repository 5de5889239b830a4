// Numbers with few digits, for messages. A bound is rounded to the side on which the program accepts it.
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

// Formats a number of at least 1 with these significant digits, and commas between thousands: "10,000".
inline std::string with_commas(double number, int digits) {
  const double digit = std::max(1.0, last_digit(number, digits));
  std::string text = fmt::format("{:.0f}", std::round(number / digit) * digit);
  for (std::size_t position = text.size(); position > 3;) {
    position -= 3;
    text.insert(position, ",");
  }
  return text;
}

// Formats a number for people, without an exponent up to 1e10: "0.35", "-1.5", "13,000". Two digits are an estimate.
inline std::string rounded_text(double number, int digits = 2) {
  constexpr double most = 1e10;
  const double size = std::abs(number);
  return size >= std::pow(10.0, digits - 1) && size < most ? (number < 0.0 ? "-" : "") + with_commas(size, digits)
                                                           : fmt::format("{:.{}g}", number, digits);
}

// Formats a whole number for people: "52,086"; with an exponent from 1e10 on.
inline std::string count_text(double number) {
  return number < 1.0 ? "0" : number < 1e10 ? with_commas(number, 10) : fmt::format("{:.3g}", number);
}

// Formats a coordinate [m] with seven significant digits, and without an exponent up to 1e10: "400805.5", "0.125".
inline std::string coordinate_text(double coordinate) {
  const double size = std::abs(coordinate);
  return size >= 1e7 && size < 1e10 ? fmt::format("{:.0f}", coordinate) : fmt::format("{:.7g}", coordinate);
}

// Formats a time in seconds for people: "12 s", "3.3 min", "1.2 h".
inline std::string duration_text(double seconds) {
  constexpr double minute = 60.0, hour = 3600.0, day = 86400.0, year = 365.25 * day;
  if (seconds < 100.0) {
    return fmt::format("{:.0f} s", seconds);
  }
  return seconds < 100.0 * minute ? rounded_text(seconds / minute) + " min"
         : seconds < 2.0 * day    ? rounded_text(seconds / hour) + " h"
         : seconds < 2.0 * year   ? rounded_text(seconds / day) + " days"
                                  : rounded_text(seconds / year) + " years";
}

}  // namespace thawslide
