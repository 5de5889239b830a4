#include "record.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

namespace thawslide::verification {

namespace {

// A single write, because tests run in parallel.
void append(const char* file, const std::string& line) {
  const int descriptor = open(file, O_WRONLY | O_APPEND | O_CREAT, 0666);
  EXPECT_EQ(write(descriptor, line.data(), line.size()), static_cast<ssize_t>(line.size())) << file;
  close(descriptor);
}

}  // namespace

Record::Record(const std::string& title, const std::string& problem, const std::string& solution,
               const std::string& source)
    : facts_(std::make_unique<nlohmann::json>()) {
  (*facts_)["title"] = title;
  (*facts_)["problem"] = problem;
  (*facts_)["solution"] = solution;
  (*facts_)["source"] = source;
}

Record::~Record() {
  if (const char* file = std::getenv("THAWSLIDE_VERIFICATION")) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    (*facts_)["test"] = std::string(test->test_suite_name()) + "." + test->name();
    append(file, facts_->dump() + "\n");
  }
}

void Record::expect_near(const std::string& what, double found, double expected, double allowed) {
  EXPECT_NEAR(found, expected, allowed) << what;
  (*facts_)["values"].push_back({{"what", what}, {"found", found}, {"expected", expected}, {"allowed", allowed}});
}

void Record::expect_order(const std::string& resolution, const std::vector<double>& resolutions,
                          const std::string& error, const std::vector<double>& errors, double expected,
                          double allowed) {
  const double found = add_order(resolution, resolutions, error, errors, expected, allowed);
  EXPECT_NEAR(found, expected, allowed) << error << " " << testing::PrintToString(errors);
}

void Record::expect_order_at_least(const std::string& resolution, const std::vector<double>& resolutions,
                                   const std::string& error, const std::vector<double>& errors, double expected,
                                   double allowed) {
  const double found = add_order(resolution, resolutions, error, errors, expected, allowed);
  (*facts_)["orders"].back()["at_least"] = true;
  EXPECT_GE(found, expected - allowed) << error << " " << testing::PrintToString(errors);
}

void Record::explain(const std::string& text) { (*facts_)["explanation"] = text; }

void Record::draw(const Curve& curve) {
  (*facts_)["curves"].push_back({{"x_label", curve.x_label},
                                 {"y_label", curve.y_label},
                                 {"x", curve.x},
                                 {"computed", curve.computed},
                                 {"exact", curve.exact},
                                 {"reference", curve.reference}});
}

double Record::add_order(const std::string& resolution, const std::vector<double>& resolutions,
                         const std::string& error, const std::vector<double>& errors, double expected, double allowed) {
  EXPECT_EQ(resolutions.size(), errors.size());
  EXPECT_GE(errors.size(), 3U);
  std::vector<double> orders;
  for (std::size_t k = 0; k + 1 < errors.size(); ++k) {
    orders.push_back(std::log(errors[k] / errors[k + 1]) / std::log(resolutions[k] / resolutions[k + 1]));
  }
  (*facts_)["orders"].push_back({{"resolution", resolution},
                                 {"resolutions", resolutions},
                                 {"error", error},
                                 {"errors", errors},
                                 {"found", orders},
                                 {"expected", expected},
                                 {"allowed", allowed},
                                 {"at_least", false}});
  return orders.back();
}

}  // namespace thawslide::verification
