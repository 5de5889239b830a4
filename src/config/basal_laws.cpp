#include "config/basal_laws.hpp"

namespace thawslide::config {

double LawNumbers::operator()(const physics::basal::Parameter& number) const {
  const auto found = by_key.find(number.key);
  return found == by_key.end() ? number.initial : found->second;
}

double& LawNumbers::operator[](const physics::basal::Parameter& number) {
  return by_key.try_emplace(number.key, number.initial).first->second;
}

}  // namespace thawslide::config
