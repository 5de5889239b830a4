// Keywords of the case file for each enumeration of the Case.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

template <class Enum>
struct Choice {
  Enum value;
  std::string keyword;
  std::string text;
};

// The argument only selects the enumeration.
inline std::vector<Choice<Stepping>> choices(Stepping) {
  return {{Stepping::fixed, "fixed", "constant time step, time.step"},
          {Stepping::adaptive, "adaptive", "time.safety times the smallest stability limit, at most time.step"}};
}
inline std::vector<Choice<BoundaryKind>> choices(BoundaryKind) {
  return {{BoundaryKind::open, "open", "no condition"},
          {BoundaryKind::roller, "roller", "zero normal velocity (free slip)"},
          {BoundaryKind::fixed, "fixed", "zero velocity (no slip)"}};
}
inline std::vector<Choice<TerrainKind>> choices(TerrainKind) {
  return {{TerrainKind::none, "none", "no terrain and no contact"},
          {TerrainKind::flat, "flat", "horizontal terrain at terrain.elevation"},
          {TerrainKind::plane, "plane", "plane that falls towards +x by terrain.slope"},
          {TerrainKind::profile, "profile", "polyline from terrain.file; in 3D, the same at every y"},
          {TerrainKind::dem, "dem", "digital elevation model (DEM) from terrain.file, in 3D only"}};
}
inline std::vector<Choice<LawKind>> choices(LawKind) {
  return {{LawKind::elastic, "elastic", "linear isotropic elasticity with an objective stress rate"},
          {LawKind::mohr_coulomb, "mohr_coulomb", "linear elasticity with Mohr-Coulomb plasticity (Eq. 11)"}};
}
inline std::vector<Choice<CurveKind>> choices(CurveKind) {
  return {{CurveKind::power_law, "power_law", "S_L = (1 - (T - Tref))^-exponent below Tref (Eq. 24)"},
          {CurveKind::linear, "linear", "S_L = 1 + slope (T - Tref), between 0 and 1 (Sec. 3.1)"}};
}
inline std::vector<Choice<BodyContact>> choices(BodyContact) {
  return {{BodyContact::bonded, "bonded",
           "bodies share one velocity field: they interact across a gap of up to two cells, stick together, and resist "
           "separation like one body"},
          {BodyContact::frictional, "frictional",
           "a velocity field per body, with Coulomb friction between bodies once the gap between them is closed; they "
           "separate freely"}};
}
inline std::vector<Choice<BedLaw>> choices(BedLaw) {
  return {{BedLaw::none, "none", "no bed"},
          {BedLaw::strength, "strength",
           "depth_per_slip is entrained if the basal shear stress reaches the strength of the bed; accelerating it "
           "causes a drag in addition to friction"},
          {BedLaw::momentum, "momentum",
           "the basal shear stress in excess of the strength of the bed accelerates bed material and thus limits the "
           "entrained depth"}};
}
inline std::vector<Choice<BodyShape>> choices(BodyShape) {
  return {{BodyShape::box, "box", "box from min to max"},
          {BodyShape::polygon, "polygon", "polygon given by vertices, in 2D only"},
          {BodyShape::surface, "surface", "area between the terrain and surface_elevation_m of terrain.file"},
          {BodyShape::release, "release", "release on or in a DEM, given by polygons and thickness, in 3D only"}};
}
inline std::vector<Choice<ThicknessAlong>> choices(ThicknessAlong) {
  return {{ThicknessAlong::vertical, "vertical", "along the vertical"},
          {ThicknessAlong::normal, "normal", "along the terrain normal"}};
}
inline std::vector<Choice<Placement>> choices(Placement) {
  return {{Placement::on_top, "on_top", "on the DEM; the mass slides on the DEM"},
          {Placement::cut, "cut", "cut out of the DEM; the mass slides on the DEM minus the thickness"}};
}
inline std::vector<Choice<Policy>> choices(Policy) {
  return {{Policy::stop, "stop", "such particles end the run"},
          {Policy::remove, "remove", "such particles are removed and counted"}};
}
inline std::vector<Choice<ShapeFunction>> choices(ShapeFunction) {
  return {{ShapeFunction::ugimp, "ugimp", "uniform generalized interpolation (uGIMP)"},
          {ShapeFunction::quadratic, "quadratic", "quadratic B-splines"}};
}
inline std::vector<Choice<Transfer>> choices(Transfer) {
  return {
      {Transfer::flip, "flip", "FLIP: particles receive the change of the nodal velocities (Eq. 13)"},
      {Transfer::blend, "blend", "FLIP with a fraction mechanics.pic_fraction of PIC, the nodal velocities themselves"},
      {Transfer::apic, "apic", "APIC: the nodal velocities and an affine velocity field about the particle"},
      {Transfer::fmpm, "fmpm",
       "FLIP with the filter FMPM, which at intervals removes velocities that the grid does not resolve"}};
}
inline std::vector<Choice<InitialStress>> choices(InitialStress) {
  return {{InitialStress::geostatic, "geostatic",
           "weight of the material above, normal to the terrain, and k0 times it along the terrain"},
          {InitialStress::none, "none", "no stress: gravity acts suddenly"},
          {InitialStress::settle, "settle",
           "the body settles before t = 0 under gravity with damped velocities, held at its base"}};
}
inline std::vector<Choice<FrictionClamp>> choices(FrictionClamp) {
  return {{FrictionClamp::keep_cohesion, "keep_cohesion", "mu_e max(0, N - P) + c_S: cohesion is kept"},
          {FrictionClamp::joint, "joint", "max(0, mu_e (N - P) + c_S): excess pressure cancels cohesion"}};
}
inline std::vector<Choice<BandRegion>> choices(BandRegion) {
  return {{BandRegion::all, "all", "all particles, as published"},
          {BandRegion::first_layer, "first_layer", "the first cell layer above the terrain"}};
}
inline std::vector<Choice<BandKind>> choices(BandKind) {
  return {{BandKind::scaled, "scaled", "heat and seepage of the particles near the base, scaled by xi"},
          {BandKind::columns, "columns",
           "1D columns of cells through terrain, band and body, which resolve the true thickness of the band and move "
           "with the base"}};
}
inline std::vector<Choice<BandGrowth>> choices(BandGrowth) {
  return {{BandGrowth::none, "none", "no growth: band.thickness"},
          {BandGrowth::inertial, "inertial",
           "e = v d sqrt(rho_S/(N - P))/I if larger than band.thickness, with N - P at least 0.02 N"},
          {BandGrowth::slip, "slip", "band.thickness plus growth_per_slip times the slip"}};
}
inline std::vector<Choice<EndOfWater>> choices(EndOfWater) {
  return {{EndOfWater::sealed, "sealed", "no flow"}, {EndOfWater::vented, "vented", "connected to the air: P = 0"}};
}
inline std::vector<Choice<ThicknessChange>> choices(ThicknessChange) {
  return {
      {ThicknessChange::as_published, "as_published",
       "temperatures remain; the heat that a thicker band then contains, or a thinner one lacks, is band_rescale_J"},
      {ThicknessChange::conserving, "conserving",
       "a thickening band gains material with the properties of t = 0 and mixes with it; a thinning band loses its "
       "own; the heat exchanged is band_rescale_J"}};
}
inline std::vector<Choice<AdvectionForm>> choices(AdvectionForm) {
  return {{AdvectionForm::as_published, "as_published",
           "rho_L C_L q_L.grad T, as in Eq. 9; the heat that it creates is advection_J"},
          {AdvectionForm::conservative, "conservative",
           "-div(rho_L C_L q_L (T - Tref)), which conserves heat; drained water removes its heat"}};
}
inline std::vector<Choice<WaterExpansionLaw>> choices(WaterExpansionLaw) {
  return {{WaterExpansionLaw::constant, "constant", "phases.water_expansion"},
          {WaterExpansionLaw::by_temperature, "by_temperature",
           "-0.7e-4 at 0 C, 2.1e-4 at 20 C, 4.6e-4 at 50 C, 7.5e-4 1/K at 100 C, linear between and beyond (source not "
           "checked)"}};
}
inline std::vector<Choice<FrozenRows>> choices(FrozenRows) {
  return {{FrozenRows::draining, "draining", "frozen pores absorb water at the pressure of their ice: a sink"},
          {FrozenRows::sealed, "sealed", "no water passes, as through ice"},
          {FrozenRows::vented, "vented", "frozen pores are connected to the air: P = 0"}};
}
inline std::vector<Choice<FrozenPressure>> choices(FrozenPressure) {
  return {{FrozenPressure::ice_pressure, "ice_pressure",
           "P_I = rho_I g H and P_L of the Clapeyron equation; after melting, P starts at P_I/r (Eqs. 4, 21)"},
          {FrozenPressure::none, "none",
           "P = 0: ice carries load as a solid; on thawing, P starts at N - residual_stress, but not below 0"}};
}
inline std::vector<Choice<HeatUpdate>> choices(HeatUpdate) {
  return {
      {HeatUpdate::enthalpy, "enthalpy", "heat content with its secant capacity; conserves heat to round-off"},
      {HeatUpdate::apparent_capacity, "apparent_capacity",
       "apparent capacity of the previous step, as published; the heat that it creates or loses is capacity_heat_J"}};
}
inline std::vector<Choice<ThicknessDirection>> choices(ThicknessDirection) {
  return {{ThicknessDirection::normal, "normal", "along the terrain normal"},
          {ThicknessDirection::vertical, "vertical", "along the vertical"}};
}
inline std::vector<Choice<ThicknessUpdate>> choices(ThicknessUpdate) {
  return {{ThicknessUpdate::each_step, "each_step", "current thickness, in each step"},
          {ThicknessUpdate::frozen, "frozen", "thickness at t = 0"}};
}

}  // namespace thawslide::config
