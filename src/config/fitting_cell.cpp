#include "config/fitting_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace thawslide::config {

namespace {

constexpr double leeway = 1.5;          // factor by which the cell may be finer or coarser
constexpr double little = 1.25;         // factor accepted for a cell of few digits if others fit better
constexpr double finest_unit = 1e-6;    // [m], of lengths: other lengths have no common measure
constexpr double longest_count = 1e15;  // units that are exact as floating-point numbers

double of_few_digits(double number) { return std::stod(fmt::format("{:.2g}", number)); }

bool has_few_digits(double number) { return std::abs(number - of_few_digits(number)) < 1e-9 * number; }

// Greatest common divisor of all lengths, in cells.
double common_cells(double cell, const std::vector<double>& lengths) {
  long common = 0;
  for (const double length : lengths) {
    common = std::gcd(common, std::lround(length / cell));
  }
  return static_cast<double>(common);
}

bool are_whole(const std::vector<double>& lengths, double unit) {
  return std::all_of(lengths.begin(), lengths.end(), [unit](double length) {
    const double units = length / unit;
    return units >= 1.0 && units < longest_count && std::abs(units - std::round(units)) < 1e-9 * units;
  });
}

// Largest length [m] of which all are whole multiples; 0 if they are not positive decimal numbers.
double common_length(const std::vector<double>& lengths) {
  double unit = 1.0;
  while (unit > 0.5 * finest_unit) {
    if (are_whole(lengths, unit)) {
      return unit * common_cells(unit, lengths);
    }
    unit = tidy(0.1 * unit);
  }
  return 0.0;
}

double times_off(double one, double other) { return std::max(one / other, other / one); }

// Length over a whole number of parts: the first of few digits within the leeway of `first` parts, counted up or down.
double few_digits_from(double length, double first, double step) {
  for (double parts = first; parts >= 1.0 && times_off(parts, first) <= leeway; parts += step) {
    if (has_few_digits(length / parts)) {
      return of_few_digits(length / parts);
    }
  }
  return length / first;
}

}  // namespace

double round_down(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  double best = tidy(power);
  for (const double digit : {1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    best = digit * power <= x * (1.0 + 1e-12) ? tidy(digit * power) : best;
  }
  return best;
}

std::vector<double> lengths_of_domain(const Case& parameters) {
  std::vector<double> lengths;
  for (std::size_t a = 0; a < static_cast<std::size_t>(parameters.general.dimension); ++a) {
    lengths.push_back(parameters.grid.max[a] - parameters.grid.min[a]);
  }
  return lengths;
}

double fitting_cell(double most, double cell, const std::vector<double>& lengths) {
  if (lengths.empty()) {
    return round_down(most);
  }
  const double largest = cell * common_cells(cell, lengths);
  return few_digits_from(largest, std::ceil(largest / most * (1.0 - 1e-9)), 1.0);
}

double fitting_cell_from(double least, double cell, const std::vector<double>& lengths) {
  const double largest = cell * common_cells(cell, lengths);
  const double most = std::floor(largest / least * (1.0 + 1e-9));
  return most < 1.0 ? least : few_digits_from(largest, most, -1.0);
}

double fitting_cell_near(double cell, const std::vector<double>& lengths) {
  const double largest = common_length(lengths), shortest = *std::min_element(lengths.begin(), lengths.end());
  double nearest = 0.0, nearest_of_few_digits = 0.0;
  const auto consider = [cell](double& best, double found) {
    best = best == 0.0 || times_off(found, cell) < times_off(best, cell) ? found : best;
  };
  double parts = std::max(1.0, std::ceil(largest / (leeway * cell)));
  while (parts <= leeway * largest / cell * (1.0 + 1e-9)) {
    const double found = largest / parts;
    ++parts;
    if (found * fewest_cells > shortest * (1.0 + 1e-9)) {
      continue;
    }
    consider(nearest, found);
    if (has_few_digits(found) && times_off(found, cell) <= little) {
      consider(nearest_of_few_digits, of_few_digits(found));
    }
  }
  return nearest_of_few_digits > 0.0 ? nearest_of_few_digits : nearest;
}

}  // namespace thawslide::config
