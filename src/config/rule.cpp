#include "config/rule.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace thawslide::config {

bool Range::contains(double value) const {
  if (std::isnan(value) || (std::isinf(value) && !infinity_allowed)) {
    return false;
  }
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  std::string text = "any number";
  if (has_low && has_high && low_open == high_open) {
    text = fmt::format("between {} and {}, ends {}", plain_number(low), plain_number(high),
                       low_open ? "excluded" : "included");
  } else if (has_low && has_high) {
    text = fmt::format("{} {} and {} {}", low_open ? ">" : ">=", plain_number(low),
                       high_open ? "<" : "<=", plain_number(high));
  } else if (has_low) {
    text = fmt::format("{} {}", low_open ? ">" : ">=", plain_number(low));
  } else if (has_high) {
    text = fmt::format("{} {}", high_open ? "<" : "<=", plain_number(high));
  }
  return infinity_allowed ? text + ", or inf" : text;
}

bool Usual::is_specified() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return low > -infinity || high < infinity;
}

std::string Usual::text(const std::string& unit) const {
  return is_specified() ? fmt::format("{:g} to {:g}{}{}{}{} (assumption)", low, high, unit.empty() ? "" : " ", unit,
                                      *where == '\0' ? "" : " ", where)
                        : "";
}

std::string plain_number(double value) { return fmt::format("{}", value); }

std::string number_text(double value) {
  const std::string text = plain_number(value);
  return text.find_first_of(".enia") == std::string::npos ? text + ".0" : text;
}

}  // namespace thawslide::config
