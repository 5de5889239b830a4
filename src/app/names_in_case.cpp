#include "app/names_in_case.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"

namespace thawslide::app {

void require_utf8(const std::string& what, const std::string& name) {
  try {
    (void)nlohmann::json(name).dump();  // throws for anything but UTF-8
  } catch (const nlohmann::json::type_error&) {
    throw UserError(fmt::format(
        "{}: '{}' is not UTF-8, which a case file is written in and which names in it have to be. Rename it.", what,
        name));
  }
}

}  // namespace thawslide::app
