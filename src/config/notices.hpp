// Values of a valid case that are unusual or probably unintended, reported before a run; they are not errors.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "config/case.hpp"

namespace thawslide::config {

// Numbers that are unusual, or plausible in another unit.
std::vector<std::string> unusual_numbers(const Case& parameters);

// Calls work(). Adds the unusual numbers of the case to a UserError, because one of them can be its cause.
template <class Work>
auto with_unusual_numbers(const Case& parameters, const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    std::string message = error.what();
    for (const std::string& each : unusual_numbers(parameters)) {
      message += "\nwarning: " + each;
    }
    throw UserError(message);
  }
}

// Young's modulus [Pa] below which a slide collapses under its own weight.
inline constexpr double softest_modulus = 1e6;

// Values that are probably unintended: each warning specifies its location and the remedy.
[[nodiscard]] std::vector<std::string> implausible(const Case& parameters);

// Each notice specifies the location, the value, the usual range and the consequence.
std::vector<std::string> notices(const Case& parameters);

}  // namespace thawslide::config
