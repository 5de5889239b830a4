#include "base_cases.hpp"

#include <map>
#include <sstream>

namespace thawslide::testing_support {

namespace {

constexpr const char* without_heat_and_water = R"(
[mechanisms]
pressurization = false
[heat]
enabled = false
[pressure]
enabled = false
)";

constexpr const char* block = R"(
[time]
end = 1.0
step = 0.001
[grid]
cell = 5.0
min = [-20.0, -10.0]
max = [200.0, 40.0]
[terrain]
type = "flat"
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
viscosity_time = 0.02
[body.block]
material = "rock"
min = [0.0, 0.0]
max = [40.0, 20.0]
[basal]
friction = "constant"
friction_angle = 20.0
)";

constexpr const char* free_block = R"(
[case]
gravity = 0.0
[time]
end = 1.0
step = 0.002
[grid]
cell = 1.0
min = [0.0, 0.0]
max = [40.0, 40.0]
[material.rock]
law = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.25
[body.block]
material = "rock"
min = [17.3, 17.6]
max = [22.3, 22.6]
[mechanics]
initial_stress = "none"
[heat]
enabled = false
[pressure]
enabled = false
)";

constexpr const char* slab = R"(
[time]
end = 2.0
step = 0.002
[grid]
cell = 10.0
min = [-50.0, -10.0]
max = [500.0, 80.0]
[terrain]
type = "flat"
[material.rock]
law = "elastic"
youngs_modulus = 1e9
poisson_ratio = 0.2
viscosity_time = 0.02
hydraulic_conductivity = 2e-8
[body.slab]
material = "rock"
min = [0.0, 0.0]
max = [200.0, 50.0]
[basal]
friction = "lubricated"
friction_angle = 25.0
[band]
thickness = 0.05
)";

// 200 m long, 40 m thick, on 30 degrees, with an initial velocity of 8 m/s.
constexpr const char* columns = R"(
[case]
gravity_tilt = 30.0
[time]
end = 6.0
step = 0.005
[grid]
cell = 10.0
min = [-60.0, -20.0]
max = [600.0, 80.0]
[terrain]
type = "flat"
[phases]
water_expansion_law = "by_temperature"
[material.rock]
law = "elastic"
youngs_modulus = 2e8
poisson_ratio = 0.2
viscosity_time = 0.02
hydraulic_conductivity = 1e-7
[body.slab]
material = "rock"
min = [0.0, 0.0]
max = [200.0, 40.0]
temperature = -1.0
porosity = 0.375
velocity = [8.0, 0.0]
[basal]
friction = "lubricated"
friction_angle = 32.0
cohesion = 0.0
heat_fraction = 0.9
[band]
model = "columns"
thickness = 0.1
thickness_change = "conserving"
[pressure]
frozen = "none"
frozen_rows = "sealed"
melt_contraction = true
skeleton_compressibility = 2e-9
)";

constexpr const char* bar = R"(
[case]
gravity = 0.0
[time]
end = 4.0e5
step = 1000.0
[grid]
cell = 0.1
min = [0.0, 0.0]
max = [4.0, 0.4]
[material.bar]
law = "elastic"
youngs_modulus = 1e7
poisson_ratio = 0.3
[body.bar]
material = "bar"
min = [0.0, 0.0]
max = [4.0, 0.4]
temperature = 2.0
[mechanics]
enabled = false
[pressure]
enabled = false
)";

constexpr const char* column = R"(
[time]
end = 100.0
step = 0.05
[grid]
cell = 0.5
min = [0.0, 0.0]
max = [1.0, 12.0]
[material.soil]
law = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.2
hydraulic_conductivity = 1e-7
[body.column]
material = "soil"
min = [0.0, 0.0]
max = [1.0, 10.0]
temperature = 5.0
[mechanics]
enabled = false
)";

// Sand with an angle of repose of 31 degrees slides along planes at tau = tan(31) sigma; without dilation such planes
// resist sin(phi) sigma (Davis 1968): phi = asin(tan(31)) = 36.9 degrees.
constexpr const char* sand = R"(
[time]
end = 6.0
step = 0.0035
[grid]
cell = 0.625
min = [0.0, -2.5]
max = [140.0, 60.0]
[grid.boundary]
x_min = "roller"
[terrain]
type = "flat"
[material.sand]
law = "mohr_coulomb"
youngs_modulus = 2e7
poisson_ratio = 0.3
friction_angle = 36.93
cohesion = 0.0
gaps_close_first = true
[body.column]
material = "sand"
min = [0.0, 0.0]
max = [10.0, 10.0]
[basal]
friction = "constant"
friction_angle = 31.0
)";

constexpr const char* release = R"(
[case]
dimension = 3
[time]
end = 5.0
step = 0.002
[grid]
cell = 5.0
min = [-100.0, -100.0, -200.0]
max = [100.0, 100.0, 200.0]
[terrain]
type = "dem"
file = "dem.tif"
[material.debris]
law = "mohr_coulomb"
youngs_modulus = 2e7
poisson_ratio = 0.3
friction_angle = 30.0
cohesion = 0.0
gaps_close_first = true
[body.slide]
material = "debris"
shape = "release"
thickness = { raster = "thickness.tif" }
[basal]
friction = "constant"
friction_angle = 15.0
)";

constexpr const char* profile = R"(
[time]
end = 30.0
step = 0.001
[grid]
cell = 2.5
min = [-340.0, -10.0]
max = [190.0, 200.0]
[terrain]
type = "profile"
file = "profile.csv"
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
viscosity_time = 0.01
[body.slide]
material = "rock"
shape = "surface"
[mechanics]
slope_shear = true
[basal]
friction = "constant"
friction_angle = 10.0
)";

constexpr const char* two_bodies = R"(
[case]
gravity_tilt = 35.0
[time]
end = 10.0
step = 0.002
[grid]
cell = 1.0
min = [-4.0, -4.0]
max = [40.0, 20.0]
[terrain]
type = "flat"
[material.frozen]
law = "mohr_coulomb"
youngs_modulus = 2e8
poisson_ratio = 0.3
friction_angle = 35.0
cohesion = 0.0
hydraulic_conductivity = 1e-9
[material.melted]
law = "mohr_coulomb"
youngs_modulus = 1e8
poisson_ratio = 0.2
friction_angle = 30.0
cohesion = 0.0
residual_cohesion = 0.0
softening_strain = 1.0
tension_cutoff = 1e5
hydraulic_conductivity = 1e-10
[body.left]
material = "frozen"
min = [0.0, 0.0]
max = [7.0, 5.0]
temperature = -0.5
porosity = 0.375
[body.right]
material = "melted"
min = [7.0, 0.0]
max = [11.3, 4.1]
temperature = 1.5
porosity = 0.3
particles_per_axis = 3
[basal]
friction = "lubricated"
friction_angle = 25.0
[band]
thickness = 0.1
)";

constexpr const char* box = R"(
[case]
dimension = 3
gravity_tilt = 25.0
[time]
end = 10.0
step = 0.002
[grid]
cell = 1.0
min = [-4.0, -5.0, -3.0]
max = [60.0, 15.0, 20.0]
[terrain]
type = "flat"
[material.rock]
law = "mohr_coulomb"
youngs_modulus = 1e7
poisson_ratio = 0.3
friction_angle = 20.0
cohesion = 0.0
hydraulic_conductivity = 1e-9
[body.box]
material = "rock"
min = [0.0, 3.0, 0.0]
max = [6.0, 7.0, 3.0]
temperature = -0.5
porosity = 0.375
[basal]
friction = "lubricated"
friction_angle = 5.0
[band]
thickness = 0.1
)";

// A function, because tests ask for texts before main().
const std::map<std::string, std::string>& all_texts() {
  const auto dry = [](const char* text) { return std::string(text) + without_heat_and_water; };
  static const std::map<std::string, std::string> texts{{"block", dry(block)},
                                                        {"free", free_block},
                                                        {"slab", slab},
                                                        {"columns", columns},
                                                        {"bar", bar},
                                                        {"column", column},
                                                        {"sand", dry(sand)},
                                                        {"release", dry(release)},
                                                        {"profile", dry(profile)},
                                                        {"two_bodies", two_bodies},
                                                        {"box", box}};
  return texts;
}

}  // namespace

Sets::Sets(const std::string& text) {
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    if (part.find_first_not_of(" \n") != std::string::npos) {
      push_back(part);
    }
  }
}

Sets::Sets(std::initializer_list<std::string> texts) : Sets(std::vector<std::string>(texts)) {}

Sets::Sets(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const Sets parts(text);
    insert(end(), parts.begin(), parts.end());
  }
}

const std::string& base_text(const std::string& name) { return all_texts().at(name); }

config::Case case_from_text(const Variant& variant, const Sets& sets) {
  return case_from_text(base_text(variant.base), variant.sets + sets);
}

config::Case paper_case(const Variant& variant, const Sets& sets) {
  return paper_case(base_text(variant.base), variant.sets + sets);
}

}  // namespace thawslide::testing_support
