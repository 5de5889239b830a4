// Checks of the width of a section, which may vary along x (mpm/section_width.hpp).
#include <fmt/format.h>

#include "config/body_layers.hpp"
#include "config/checks.hpp"

namespace thawslide::config {

namespace {

const std::string key = "case.width";

// True if some bodies have frictional contact; false while the case has problems.
bool bodies_are_apart(const Case& checked, const Reading& reading) {
  return reading.problems.empty() && !checked.bodies.empty() && body_layers(checked).count > 1;
}

}  // namespace

void check_width(const Case& checked, Reading& reading) {
  if (!reading.are_valid({key})) {
    return;
  }
  if (checked.general.dimension == 3 && reading.is_given(key)) {  // [case] is read before its dimension is known
    reading.report_misfit(
        {key, "case.dimension"},
        fmt::format("{} has a meaning only in two dimensions, and case.dimension is 3. Remove it.", key));
    return;
  }
  if (!checked.general.width.varies()) {
    return;
  }
  const struct {
    bool is_given;
    const char* what;
  } others[] = {
      {reading.are_valid({"bed.law"}) && checked.bed.law != BedLaw::none, "an erodible bed ([bed])"},
      {!checked.frames.empty(), "a rigid frame ([frame.NAME])"},
      {has_stages(checked), "a release in stages (body.NAME.release_time)"},
      {bodies_are_apart(checked, reading), "frictional contact between bodies ([contact])"},
  };
  for (const auto& other : others) {
    if (other.is_given) {
      reading.report_misfit({key}, fmt::format("{}: a width that varies along x and {} exclude each other. Give one "
                                               "width, or remove the latter.",
                                               key, other.what));
      return;
    }
  }
}

}  // namespace thawslide::config
