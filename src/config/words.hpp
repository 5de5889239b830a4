// The words of the case file for each enumeration of the Case.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

template <class Enum>
struct Choice {
  Enum value;
  std::string word;
  std::string text;
};

// The argument only chooses the enumeration.
inline std::vector<Choice<Stepping>> choices(Stepping) {
  return {{Stepping::fixed, "fixed", "every step is time.step"},
          {Stepping::adaptive, "adaptive", "a share of the smallest limit, at most time.step"}};
}
inline std::vector<Choice<BoundaryKind>> choices(BoundaryKind) {
  return {{BoundaryKind::open, "open", "nothing is prescribed"},
          {BoundaryKind::roller, "roller", "no velocity across the side"},
          {BoundaryKind::fixed, "fixed", "no velocity at the side"}};
}
inline std::vector<Choice<TerrainKind>> choices(TerrainKind) {
  return {{TerrainKind::none, "none", "no ground, no contact"},
          {TerrainKind::flat, "flat", "level ground at terrain.elevation"},
          {TerrainKind::plane, "plane", "a plane that falls towards +x by terrain.slope"},
          {TerrainKind::profile, "profile", "a polyline read from terrain.file (2D)"}};
}
inline std::vector<Choice<LawKind>> choices(LawKind) {
  return {{LawKind::elastic, "elastic", "linear isotropic, objective rate"},
          {LawKind::mohr_coulomb, "mohr_coulomb", "elastic, with Mohr-Coulomb plasticity (Eq. 11)"}};
}
inline std::vector<Choice<CurveKind>> choices(CurveKind) {
  return {{CurveKind::power_law, "power_law", "S_L = (1 - (T - Tref))^-exponent below Tref (Eq. 24)"},
          {CurveKind::linear, "linear", "S_L = 1 + slope (T - Tref), between 0 and 1 (Sec. 3.1)"}};
}
inline std::vector<Choice<BodyShape>> choices(BodyShape) {
  return {{BodyShape::box, "box", "between min and max"},
          {BodyShape::polygon, "polygon", "inside vertices (2D)"},
          {BodyShape::surface, "surface", "between the terrain and surface_elevation_m of terrain.file"}};
}
inline std::vector<Choice<ShapeFunction>> choices(ShapeFunction) {
  return {{ShapeFunction::ugimp, "ugimp", "uniform generalised interpolation"},
          {ShapeFunction::linear, "linear", "linear hat functions"}};
}
inline std::vector<Choice<InitialStress>> choices(InitialStress) {
  return {{InitialStress::geostatic, "geostatic", "the weight above, and k0 times it sideways"},
          {InitialStress::none, "none", "stress-free: gravity acts suddenly"},
          {InitialStress::settle, "settle", "gravity acts on the damped body before t = 0"}};
}
inline std::vector<Choice<FrictionLaw>> choices(FrictionLaw) {
  return {{FrictionLaw::constant, "constant", "tan(friction_angle)"},
          {FrictionLaw::lubricated, "lubricated", "falls as ice melts (Eq. 25)"}};
}
inline std::vector<Choice<CohesionLaw>> choices(CohesionLaw) {
  return {{CohesionLaw::constant, "constant", "kept for ever"},
          {CohesionLaw::slip, "slip", "c_r + (c_0 - c_r) exp(-slip/slip_distance)"},
          {CohesionLaw::ice, "ice", "cohesion (1 - S_L): in proportion to the ice"},
          {CohesionLaw::time, "time", "c_0 before cohesion_loss_time, c_r from then on"}};
}
inline std::vector<Choice<FrictionClamp>> choices(FrictionClamp) {
  return {{FrictionClamp::keep_cohesion, "keep_cohesion", "mu max(0, N - P) + c"},
          {FrictionClamp::joint, "joint", "max(0, mu (N - P) + c)"}};
}
inline std::vector<Choice<BandRegion>> choices(BandRegion) {
  return {{BandRegion::all, "all", "all particles, as printed"},
          {BandRegion::first_layer, "first_layer", "the first cell layer above the terrain"}};
}
inline std::vector<Choice<ClapeyronSign>> choices(ClapeyronSign) {
  return {{ClapeyronSign::usual, "usual", "pressure falls below the freezing point"},
          {ClapeyronSign::printed, "printed", "the minus sign of Eq. 4 as printed"}};
}
inline std::vector<Choice<ThicknessDirection>> choices(ThicknessDirection) {
  return {{ThicknessDirection::normal, "normal", "along the terrain normal"},
          {ThicknessDirection::vertical, "vertical", "along the vertical"}};
}
inline std::vector<Choice<ThicknessUpdate>> choices(ThicknessUpdate) {
  return {{ThicknessUpdate::each_step, "each_step", "follows the body"},
          {ThicknessUpdate::frozen, "frozen", "as at t = 0"}};
}

}  // namespace thawslide::config
