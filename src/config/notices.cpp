#include "config/notices.hpp"

#include <fmt/format.h>

#include "config/moved_defaults.hpp"

namespace thawslide::config {

namespace {

// What docs/theory/stress.md has for broken rock and ice; its sources are not checked.
constexpr double least_softening_strain = 0.005, most_softening_strain = 0.05;
constexpr double least_broken_angle = 20.0, most_broken_angle = 35.0;  // degrees
constexpr double most_broken_cohesion = 50e3;                          // Pa

// The paper's softening, of cohesion alone over a plastic strain of 1, is left as it is.
bool softens_otherwise(const Material& material) {
  constexpr double strain_of_the_paper = 1.0;
  const bool falls = material.residual_cohesion < material.cohesion;
  const bool loses_friction = material.residual_friction_angle < material.friction_angle;
  return loses_friction || (falls && material.softening_strain != strain_of_the_paper);
}

void add_of_broken_matter(const Case& parameters, const std::string& name, const Material& material,
                          std::vector<std::string>& notices) {
  const auto note = [&](const std::string& key, const std::string& found, const std::string& rest) {
    const std::string dotted = "material." + name + "." + key;
    notices.push_back(fmt::format("{}: {} is {}, {}", place_of(parameters, dotted), dotted, found, rest));
  };
  if (material.softening_strain < least_softening_strain || material.softening_strain > most_softening_strain) {
    note("softening_strain", fmt::format("{:g}", material.softening_strain),
         fmt::format("outside the {:g} to {:g} over which broken rock and ice usually lose their strength",
                     least_softening_strain, most_softening_strain));
  }
  if (material.residual_friction_angle < least_broken_angle || material.residual_friction_angle > most_broken_angle) {
    note("residual_friction_angle", fmt::format("{:g} degrees", material.residual_friction_angle),
         fmt::format("outside the {:g} to {:g} degrees that are usual for broken rock and ice", least_broken_angle,
                     most_broken_angle));
  }
  if (material.residual_cohesion > most_broken_cohesion) {
    note("residual_cohesion", fmt::format("{:g} Pa", material.residual_cohesion),
         fmt::format("above the {:g} Pa that broken rock and ice usually have at most", most_broken_cohesion));
  }
}

}  // namespace

std::vector<std::string> notices(const Case& parameters) {
  std::vector<std::string> notices;
  if (const std::string moved = notice_of_moved_defaults(parameters); !moved.empty()) {
    notices.push_back(moved);
  }
  for (const auto& [name, material] : parameters.materials) {
    if (material.law == LawKind::mohr_coulomb && softens_otherwise(material)) {
      add_of_broken_matter(parameters, name, material, notices);
    }
  }
  return notices;
}

}  // namespace thawslide::config
