#include "config/notices.hpp"

#include <fmt/format.h>

#include "config/changed_defaults.hpp"
#include "config/declaration.hpp"
#include "config/plausibility.hpp"
#include "config/strips.hpp"

namespace thawslide::config {

std::vector<std::string> notices(const Case& parameters) {
  std::vector<std::string> notices = parameters.notes;
  if (const std::string warning = changed_defaults_warning(parameters); !warning.empty()) {
    notices.push_back(warning);
  }
  std::vector<Unusual> unusual;
  for (const auto& table : tables()) {
    table->find_unusual(parameters, unusual);
  }
  for (const Unusual& found : unusual) {
    const Rule& rule = *found.rule;
    notices.push_back(fmt::format("{}: {} is {:g}{}{}, outside the usual {}", location_of(parameters, found.key),
                                  found.key, found.value, rule.unit.empty() ? "" : " ", rule.unit,
                                  rule.usual.text(rule.unit)));
  }
  for (const auto& more : {implausible(parameters), warnings_of_gaps(parameters)}) {
    notices.insert(notices.end(), more.begin(), more.end());
  }
  return notices;
}

}  // namespace thawslide::config
