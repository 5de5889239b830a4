// Messages at the place of a key of the case: "case.toml:12:7: terrain.file: ...", "--dem: ..."
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "config/case.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

[[noreturn]] void fail_at(const config::Case& parameters, const std::string& key, const std::string& message);

// What the work says of a file is told at the key that named it.
template <class Work>
auto with_error_location(const config::Case& parameters, const std::string& key, const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    fail_at(parameters, key, error.what());
  }
}

// Adds a note that has a text.
void add_warning(const std::string& warning, std::vector<std::string>& warnings);

// How far a rectangle reaches beyond another: "120 m in the west and 30 m in the north"; empty: it does not.
[[nodiscard]] std::string describe_overhang(const Rectangle& inner, const Rectangle& outer);

// "x from 0 to 10, y from 2 to 5"
[[nodiscard]] std::string format_range(const Rectangle& rectangle);

// The domain's sides.
[[nodiscard]] Rectangle domain_of(const config::Case& parameters);

}  // namespace thawslide::gis
