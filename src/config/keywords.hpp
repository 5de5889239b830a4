// Keywords of the case file for each enumeration of the Case.
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

// The argument only selects the enumeration.
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
          {TerrainKind::profile, "profile", "a polyline read from terrain.file; in 3D the same at every y"},
          {TerrainKind::dem, "dem", "a digital elevation model read from terrain.file (3D)"}};
}
inline std::vector<Choice<TerrainForm>> choices(TerrainForm) {
  return {{TerrainForm::signed_distance, "signed_distance", "normal and area from the line or surface itself"},
          {TerrainForm::rigid_points, "rigid_points", "from rigid material points in layers (Secs. 3.3 and 4)"}};
}
inline std::vector<Choice<LawKind>> choices(LawKind) {
  return {{LawKind::elastic, "elastic", "linear isotropic elasticity, objective stress rate"},
          {LawKind::mohr_coulomb, "mohr_coulomb", "elastic, with Mohr-Coulomb plasticity (Eq. 11)"}};
}
inline std::vector<Choice<CurveKind>> choices(CurveKind) {
  return {{CurveKind::power_law, "power_law", "S_L = (1 - (T - Tref))^-exponent below Tref (Eq. 24)"},
          {CurveKind::linear, "linear", "S_L = 1 + slope (T - Tref), between 0 and 1 (Sec. 3.1)"}};
}
inline std::vector<Choice<BodyContact>> choices(BodyContact) {
  return {
      {BodyContact::bonded, "bonded",
       "bodies share one velocity field: they act on one another across a gap of up to two cells, stick, and resist "
       "being pulled apart as one body does"},
      {BodyContact::frictional, "frictional",
       "a velocity field per body, with Coulomb friction between bodies once the gap between them is closed; they "
       "separate freely"}};
}
inline std::vector<Choice<BedLaw>> choices(BedLaw) {
  return {{BedLaw::none, "none", "there is no bed to entrain"},
          {BedLaw::strength, "strength",
           "depth_per_slip is entrained if the basal shear stress reaches the strength of the bed; its impulse adds a "
           "drag to friction"},
          {BedLaw::momentum, "momentum",
           "the basal shear stress in excess of the strength of the bed sets bed material in motion, as much as its "
           "impulse allows"}};
}
inline std::vector<Choice<BodyShape>> choices(BodyShape) {
  return {{BodyShape::box, "box", "between min and max"},
          {BodyShape::polygon, "polygon", "inside vertices (2D)"},
          {BodyShape::surface, "surface", "between the terrain and surface_elevation_m of terrain.file"},
          {BodyShape::release, "release", "what is released on or in a DEM: polygons and thickness (3D)"}};
}
inline std::vector<Choice<ThicknessAlong>> choices(ThicknessAlong) {
  return {{ThicknessAlong::vertical, "vertical", "along the vertical"},
          {ThicknessAlong::normal, "normal", "across the ground, along its normal"}};
}
inline std::vector<Choice<Placement>> choices(Placement) {
  return {{Placement::on_top, "on_top", "put on the DEM, which it slides on"},
          {Placement::cut, "cut", "cut out of the DEM: it slides on the DEM less the thickness"}};
}
inline std::vector<Choice<Policy>> choices(Policy) {
  return {{Policy::stop, "stop", "they end the run"}, {Policy::remove, "remove", "they are removed and counted"}};
}
inline std::vector<Choice<ShapeFunction>> choices(ShapeFunction) {
  return {{ShapeFunction::ugimp, "ugimp", "uniform generalised interpolation"},
          {ShapeFunction::linear, "linear", "linear shape functions"},
          {ShapeFunction::quadratic, "quadratic", "quadratic B-splines"}};
}
inline std::vector<Choice<Transfer>> choices(Transfer) {
  return {{Transfer::flip, "flip", "particles take the changes of node velocities (Eq. 13)"},
          {Transfer::blend, "blend", "FLIP, and a share of the node velocities themselves (PIC)"},
          {Transfer::apic, "apic", "the node velocities, and an affine velocity about the particle"},
          {Transfer::fmpm, "fmpm", "FLIP, and now and then a filter that takes out what the grid cannot see (FMPM)"}};
}
inline std::vector<Choice<InitialStress>> choices(InitialStress) {
  return {
      {InitialStress::geostatic, "geostatic", "the weight above across the ground, and k0 times it along the ground"},
      {InitialStress::none, "none", "stress-free: gravity acts suddenly"},
      {InitialStress::settle, "settle", "gravity acts on the damped body, held by its base, before t = 0"}};
}
inline std::vector<Choice<FrictionClamp>> choices(FrictionClamp) {
  return {{FrictionClamp::keep_cohesion, "keep_cohesion", "mu_e max(0, N - P) + c_S: cohesion is kept"},
          {FrictionClamp::joint, "joint", "max(0, mu_e (N - P) + c_S): excess pressure cancels cohesion"}};
}
inline std::vector<Choice<BandRegion>> choices(BandRegion) {
  return {{BandRegion::all, "all", "all particles, as published"},
          {BandRegion::first_layer, "first_layer", "the first cell layer above the terrain"}};
}
inline std::vector<Choice<CutCells>> choices(CutCells) {
  return {{CutCells::as_they_are, "as_they_are", "its cells hold what lies in them: xi = grid.cell / e everywhere"},
          {CutCells::equal_thickness, "equal_thickness", "xi is such that what lies in them counts as thick as e"}};
}
inline std::vector<Choice<BandKind>> choices(BandKind) {
  return {{BandKind::scaled, "scaled", "the lowest rows of particles, their heat and seepage scaled by xi"},
          {BandKind::columns, "columns",
           "columns of cells through ground, band and body, of the band's true thickness, that move with the base"}};
}
inline std::vector<Choice<BandGrowth>> choices(BandGrowth) {
  return {{BandGrowth::none, "none", "the band is as thick as thickness says"},
          {BandGrowth::inertial, "inertial",
           "e = v d sqrt(rho_S/(N - P))/I where that is more, with N - P at least 0.02 N"},
          {BandGrowth::slip, "slip", "thickness plus growth_per_slip times the slip"}};
}
inline std::vector<Choice<EndOfWater>> choices(EndOfWater) {
  return {{EndOfWater::sealed, "sealed", "nothing passes"}, {EndOfWater::vented, "vented", "air, at P = 0"}};
}
inline std::vector<Choice<ThicknessChange>> choices(ThicknessChange) {
  return {{ThicknessChange::as_published, "as_printed",
           "temperatures stay: the heat that a thicker band then holds, or a thinner one lacks, is band_rescale_J"},
          {ThicknessChange::conserving, "conserving",
           "a thickening band gains material with the properties of t = 0 and mixes with it; a thinning band loses its "
           "own; the heat exchanged is band_rescale_J"}};
}
inline std::vector<Choice<AdvectionForm>> choices(AdvectionForm) {
  return {{AdvectionForm::as_published, "as_printed",
           "rho_L C_L q_L.grad T, as Eq. 9 has it: what it makes is advection_J"},
          {AdvectionForm::conservative, "conservative",
           "-div(rho_L C_L q_L (T - Tref)): nothing is made, and water that drains takes its heat along"}};
}
inline std::vector<Choice<WaterExpansionLaw>> choices(WaterExpansionLaw) {
  return {{WaterExpansionLaw::constant, "constant", "water_expansion"},
          {WaterExpansionLaw::by_temperature, "by_temperature",
           "-0.7e-4 at 0 C, 2.1e-4 at 20, 4.6e-4 at 50, 7.5e-4 1/K at 100, linear between and beyond"}};
}
inline std::vector<Choice<FrozenRows>> choices(FrozenRows) {
  return {{FrozenRows::draining, "draining", "its pores absorb water at the pressure of their ice: a sink"},
          {FrozenRows::sealed, "sealed", "no water passes, as through ice"},
          {FrozenRows::vented, "vented", "its pores lead to the air: P = 0 there"}};
}
inline std::vector<Choice<FrozenPressure>> choices(FrozenPressure) {
  return {{FrozenPressure::ice_pressure, "ice_pressure",
           "P_I = rho_I g H and Clapeyron's P_L, and from P_I/r on once melted (Eqs. 4, 21)"},
          {FrozenPressure::none, "none",
           "P = 0: ice carries load as a solid does; on thawing P starts at N - residual_stress, never below 0"}};
}
inline std::vector<Choice<HeatUpdate>> choices(HeatUpdate) {
  return {
      {HeatUpdate::enthalpy, "enthalpy", "heat content with its secant capacity: closes to round-off"},
      {HeatUpdate::apparent_capacity, "apparent_capacity",
       "the apparent capacity of the previous step, as published: the heat it creates or loses is capacity_heat_J"}};
}
inline std::vector<Choice<HeatMasses>> choices(HeatMasses) {
  return {{HeatMasses::initial, "initial", "those of t = 0: no heat and no mass is made"},
          {HeatMasses::current, "current",
           "from the current porosity and volume, as published: the heat they create is porosity_heat_J"}};
}
inline std::vector<Choice<ClapeyronSign>> choices(ClapeyronSign) {
  return {{ClapeyronSign::usual, "usual",
           "plus: P_L = P_I/r + rho_L L_f ln(T/Tref), pressure falls with temperature below Tref"},
          {ClapeyronSign::printed, "printed", "minus, as Eq. 4 is printed"}};
}
inline std::vector<Choice<SeepageScaling>> choices(SeepageScaling) {
  return {{SeepageScaling::consistent, "consistent", "flow times xi, pore space over xi, as Eq. 19 does with heat"},
          {SeepageScaling::printed, "printed", "flow times xi, whole pore space, as Eq. 23 is printed"}};
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
