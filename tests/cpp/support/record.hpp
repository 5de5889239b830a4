// What a verification test found, for docs/verification.md: appended as a line of JSON to the file that the environment
// variable THAWSLIDE_VERIFICATION names, if it names one. scripts/verification-page reads it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace thawslide::verification {

// Numbers of ours over exact ones, to draw.
struct Curve {
  std::string x_label, y_label;
  std::vector<double> x, computed, exact;
};

class Record {
 public:
  Record(std::string title, std::string problem, std::string solution, std::string source) {
    json_["title"] = std::move(title);
    json_["problem"] = std::move(problem);
    json_["solution"] = std::move(solution);
    json_["source"] = std::move(source);
  }

  // Asserts |found - expected| <= allowed.
  void expect_near(const std::string& what, double found, double expected, double allowed) {
    EXPECT_NEAR(found, expected, allowed) << what;
    json_["values"].push_back({{"what", what}, {"found", found}, {"expected", expected}, {"allowed", allowed}});
  }

  // Errors over resolutions, coarse to fine, and the order between neighbours; asserts that the order of the finest
  // pair is what theory says, up to a difference: an order above theory asks for its reason as well.
  void expect_order(const std::string& resolution, const std::vector<double>& resolutions, const std::string& error,
                    const std::vector<double>& errors, double expected, double allowed) {
    const double found = note_order(resolution, resolutions, error, errors, expected, allowed);
    EXPECT_NEAR(found, expected, allowed) << error << " " << testing::PrintToString(errors);
  }

  // The same where theory bounds the error from above only: asserts an order of at least expected - allowed.
  void expect_order_at_least(const std::string& resolution, const std::vector<double>& resolutions,
                             const std::string& error, const std::vector<double>& errors, double expected,
                             double allowed) {
    const double found = note_order(resolution, resolutions, error, errors, expected, allowed);
    json_["orders"].back()["at_least"] = true;
    EXPECT_GE(found, expected - allowed) << error << " " << testing::PrintToString(errors);
  }

  // Says why an order is what it is.
  void explain(const std::string& text) { json_["explanation"] = text; }

  void draw(const Curve& curve) {
    json_["curves"].push_back({{"x_label", curve.x_label},
                               {"y_label", curve.y_label},
                               {"x", curve.x},
                               {"computed", curve.computed},
                               {"exact", curve.exact}});
  }

  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() {
    if (const char* file = std::getenv("THAWSLIDE_VERIFICATION")) {
      const auto* test = testing::UnitTest::GetInstance()->current_test_info();
      json_["test"] = std::string(test->test_suite_name()) + "." + test->name();
      append(file, json_.dump() + "\n");
    }
  }

 private:
  // In one write, since tests run side by side.
  static void append(const char* file, const std::string& line) {
    const int descriptor = open(file, O_WRONLY | O_APPEND | O_CREAT, 0666);
    EXPECT_EQ(write(descriptor, line.data(), line.size()), static_cast<ssize_t>(line.size())) << file;
    close(descriptor);
  }
  // Keeps the errors and the orders between neighbours; returns the last order.
  double note_order(const std::string& resolution, const std::vector<double>& resolutions, const std::string& error,
                    const std::vector<double>& errors, double expected, double allowed) {
    EXPECT_EQ(resolutions.size(), errors.size());
    EXPECT_GE(errors.size(), 3U);
    std::vector<double> orders;
    for (std::size_t k = 0; k + 1 < errors.size(); ++k) {
      orders.push_back(std::log(errors[k] / errors[k + 1]) / std::log(resolutions[k] / resolutions[k + 1]));
    }
    json_["orders"].push_back({{"resolution", resolution},
                               {"resolutions", resolutions},
                               {"error", error},
                               {"errors", errors},
                               {"found", orders},
                               {"expected", expected},
                               {"allowed", allowed},
                               {"at_least", false}});
    return orders.back();
  }

  nlohmann::json json_;
};

inline double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace thawslide::verification
