// Messages at the location of a key of the case: "case.toml:12:7: terrain.file: ...", "--dem: ..."
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "config/case.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

[[noreturn]] void fail_at(const config::Case& parameters, const std::string& key, const std::string& message);

// The same with a format of fmt and its values.
template <class... Values>
requires(sizeof...(Values) > 0) [[noreturn]] void fail_at(const config::Case& parameters, const std::string& key,
                                                          fmt::format_string<Values...> form, Values&&... values) {
  fail_at(parameters, key, fmt::format(form, std::forward<Values>(values)...));
}

// Adds the location of the key that named a file to errors of `work`.
template <class Work>
auto with_error_location(const config::Case& parameters, const std::string& key, const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    fail_at(parameters, key, error.what());
  }
}

// Appends a warning unless it is empty.
void add_warning(const std::string& warning, std::vector<std::string>& warnings);

// Distance by which a rectangle extends beyond another, such as "120 m in the west and 30 m in the north"; empty if it
// does not.
[[nodiscard]] std::string describe_overhang(const Rectangle& inner, const Rectangle& outer);

// "x from 0 to 10, y from 2 to 5"
[[nodiscard]] std::string format_range(const Rectangle& rectangle);

// Sides of the domain.
[[nodiscard]] Rectangle domain_of(const config::Case& parameters);

}  // namespace thawslide::gis
