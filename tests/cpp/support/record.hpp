// What a verification test found, for docs/verification.md: appended as a line of JSON to the file that the environment
// variable THAWSLIDE_VERIFICATION names, if it names one. scripts/verification-page reads it.
#pragma once

#include <cmath>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace thawslide::verification {

// Computed numbers and those to compare with, to draw; `reference` names the latter in the legend.
struct Curve {
  std::string x_label, y_label;
  std::vector<double> x, computed, exact;
  std::string reference = "exact";
};

class Record {
 public:
  Record(const std::string& title, const std::string& problem, const std::string& solution, const std::string& source);
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record();

  // Asserts |found - expected| <= allowed.
  void expect_near(const std::string& what, double found, double expected, double allowed);

  // Errors over resolutions, coarse to fine, and the order between neighbours; asserts that the order of the finest
  // pair is what theory says, up to a difference: an order above theory asks for its reason as well.
  void expect_order(const std::string& resolution, const std::vector<double>& resolutions, const std::string& error,
                    const std::vector<double>& errors, double expected, double allowed);

  // The same where theory bounds the error from above only: asserts an order of at least expected - allowed.
  void expect_order_at_least(const std::string& resolution, const std::vector<double>& resolutions,
                             const std::string& error, const std::vector<double>& errors, double expected,
                             double allowed);

  // Says why an order is what it is.
  void explain(const std::string& text);

  void draw(const Curve& curve);

 private:
  // Keeps the errors and the orders between neighbours; returns the last order.
  double update_sort_heuristic(const std::string& resolution, const std::vector<double>& resolutions,
                               const std::string& error, const std::vector<double>& errors, double expected,
                               double allowed);

  std::unique_ptr<nlohmann::json> facts_;
};

inline double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace thawslide::verification
