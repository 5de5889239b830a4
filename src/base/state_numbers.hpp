// Numbers of a checkpoint in addition to the particles, and their reader, which validates what a checksum does not.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace thawslide {

using NamedNumbers = std::map<std::string, std::vector<double>>;

class StateNumbers {
 public:
  // what: name of the state in messages, such as "band columns". Keeps a reference to the numbers.
  StateNumbers(const std::vector<double>& numbers, const char* name) : numbers_(numbers), name_(name) {}

  [[nodiscard]] std::size_t left() const { return numbers_.size() - next_; }
  double next() {
    if (left() == 0) {
      fail(fmt::format("it has {} numbers, which are too few", numbers_.size()));
    }
    return numbers_[next_++];
  }
  // Next number, which must be finite.
  double next_finite() {
    const double number = next();
    if (!std::isfinite(number)) {
      fail(fmt::format("it has {} for its number {}, which must be finite", number, next_));
    }
    return number;
  }
  // Next number, which must be an integer from 0 to `most`.
  std::int64_t whole(std::int64_t most) {
    const double number = next();
    if (!(number >= 0.0 && number <= static_cast<double>(most) && number == std::floor(number))) {
      fail(fmt::format("it has {} for its number {}; allowed: whole numbers from 0 to {}", number, next_, most));
    }
    return static_cast<std::int64_t>(number);
  }
  // Next number, which must be a count of items with `numbers_each` numbers, stored after `header` further numbers.
  std::size_t count(std::size_t numbers_each, std::size_t header = 0) {
    const std::size_t available = left() > header ? (left() - 1 - header) / numbers_each : 0;
    return static_cast<std::size_t>(whole(static_cast<std::int64_t>(available)));
  }
  void expect_end() const {
    if (left() > 0) {
      fail(fmt::format("{} of its {} numbers are left over", left(), numbers_.size()));
    }
  }
  [[noreturn]] void fail(const std::string& found) const {
    throw UserError(
        "the checkpoint's state of the {} is none that a run has: {}. Use another copy of the checkpoint, or run the "
        "case from its start.",
        name_, found);
  }

 private:
  const std::vector<double>& numbers_;
  const char* name_;
  std::size_t next_ = 0;
};

// Block of a checkpoint by name.
inline const std::vector<double>& block_of(const NamedNumbers& blocks, const char* name) {
  const auto found = blocks.find(name);
  if (found == blocks.end()) {
    throw UserError(
        "the checkpoint's state of the run is none that a run has: it has no block '{}' among {}. Use another copy of "
        "the checkpoint, or run the case from its start.",
        name, blocks.size());
  }
  return found->second;
}

inline constexpr std::int64_t largest_whole = std::int64_t{1} << 53;  // largest range of exactly representable integers

}  // namespace thawslide
