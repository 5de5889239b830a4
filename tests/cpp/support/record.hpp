// Results of a verification test for docs/verification.md: appended as a line of JSON to the file named by the
// environment variable THAWSLIDE_VERIFICATION, if set. scripts/pages --only verification reads it.
#pragma once

#include <cmath>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace thawslide::verification {

// Computed and reference values for a plot; `reference` names the latter in the legend.
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

  // Records errors over resolutions, coarse to fine, and the order between consecutive ones. Asserts that the order of
  // the finest pair agrees with theory to within `allowed`: an order above theory needs an explanation as well.
  void expect_order(const std::string& resolution, const std::vector<double>& resolutions, const std::string& error,
                    const std::vector<double>& errors, double expected, double allowed);

  // The same if theory bounds the error only from above: asserts an order of at least expected - allowed.
  void expect_order_at_least(const std::string& resolution, const std::vector<double>& resolutions,
                             const std::string& error, const std::vector<double>& errors, double expected,
                             double allowed);

  // Records the reason for an order.
  void explain(const std::string& text);

  void draw(const Curve& curve);

 private:
  // Records the errors and the orders between consecutive resolutions; returns the last order.
  double add_order(const std::string& resolution, const std::vector<double>& resolutions, const std::string& error,
                   const std::vector<double>& errors, double expected, double allowed);

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
