// Column through the base of the sliding mass: ground, shear band and the body above, per area of the base. It belongs
// to a basal segment and moves with it. Its cells are stacked along the normal. Those of the band divide its true
// thickness e; the heights of those above and below grow with the distance from it, above by a ratio that keeps the
// column within the sliding mass.
//   heat      d(A H)/dt = A (eta tau v over e - div q_T) + inflow,         q_T = -k grad T
//   water     d(A w)/dt = -A div (rho_L q) + inflow - steam,               q = -(k_L/gamma_w) grad P
//   surplus   theta = v (1 + integral of beta_L dT) - n + (1 - n) beta_S (T - Tref) + m_v (N - N_thaw) + S_s P_thaw,
//             v = w/(rho_L dz) the volume of water, integrals from Tref on
//   pressure  P = theta/S_s within P_steam <= P <= N,   S_s = n/K_L + m_v
// H is the enthalpy [J/m2] and w the ice and water [kg/m2] of a cell, A the area of the segment. Water that exceeds the
// pore space at P = N lifts the sliding mass (opening); water that does not fill its pores leaves a void. Both follow
// from w, which conserves water. Melting creates a void: n (1 - rho_I/rho_L) of the volume. A void contains steam at
// the pressure P_steam at which the water boils, relative to the atmosphere, and none below 100 C; steam that carries
// the load escapes. Frozen material has P = 0 and is impermeable; on thawing, P is P_thaw = max(0, N - s0) minus the
// part relieved by the void (Morgenstern and Nixon 1971). As the segment stretches or the band grows, the cells take in
// the material above them, and the body supplies the rest; shear mixes the band. Replaces Eqs. 19 and 23; docs/theory,
// section 10.
#pragma once

#include "physics/boiling.hpp"
#include "physics/heat_content.hpp"
#include "physics/mixture.hpp"
#include "physics/options.hpp"
#include "physics/pore_water.hpp"

namespace thawslide::physics {

// Cells, from the deepest in the ground upwards.
struct ColumnCells {
  static constexpr int ground = 6, band = 8, above = 12;
  static constexpr int slide = band + above;
  static constexpr int all = ground + slide;
};

template <class Curve>
struct ColumnModel {
  Phases phases;
  Curve curve;
  WaterExpansion water_expansion;
  double porosity = 0;                  // n
  double hydraulic_conductivity = 0;    // k_L [m/s]
  double skeleton_compressibility = 0;  // m_v [1/Pa]
  double residual_stress = 0;           // s0 [Pa]; at N or above: no excess pressure on thawing
  EndOfWater at_frozen = EndOfWater::sealed, at_top = EndOfWater::vented;
  double water_to_steam_viscosity = 0;  // ratio; 0: no seepage of steam
  bool latent = true, conduction = true, seepage = true, pressurization = true, steam = true;
  double ground_conductivity = 0;  // [W/m/K]
  double ground_capacity = 0;      // [J/m3/K]
  double ground_cell = 0;          // height of the ground's uppermost cell [m]
  double growth = 1.4;             // height of a cell over that of its neighbour nearer to the band; above: at most
};

struct BandColumn {
  double pressure[ColumnCells::slide];   // P [Pa]
  double thickness;                      // of the band, e [m]
  double cell_growth;                    // r: height ratio of a cell above the band to the one below it
  double heat[ColumnCells::all];         // H [J/m2]
  double temperature[ColumnCells::all];  // [C], from H
  double water[ColumnCells::slide];      // w [kg/m2]
  double thawing[ColumnCells::slide];    // S_s P_thaw - m_v N_thaw; for frozen cells, the value on thawing now
  double surplus[ColumnCells::slide];    // theta
};

// Input of a column's time step.
struct ColumnDrive {
  double dt;               // [s]
  double normal_pressure;  // N [Pa], at least 0
  double heat_flux;        // eta tau v [W/m2]
  double stretching;       // dA/dt / A [1/s]
  double thickness;        // of the band at the end of the step [m]
  double cell_growth;      // r at the end of the step
  double mixed;            // fraction of the band that shear mixes in the step, 0 to 1
  double body_heat;        // enthalpy of material from the body at the top [J/m3]
  double body_water;       // its ice and water [kg/m3]
};

// Budget of a column, per area at the end of the step.
struct ColumnBudget {
  double friction_heat = 0, body_heat = 0, ground_heat = 0, vented_heat = 0, steam_heat = 0;  // [J/m2]
  double body_water = 0, vented_water = 0, steam = 0;                                         // [kg/m2]
};

// Ice and water [kg/m3] of material with full pores at a temperature [C].
template <class Curve>
THAWSLIDE_HD double water_of_full_pores(const ColumnModel<Curve>& model, double temperature) {
  const double saturation = model.curve.saturation(temperature);
  return model.porosity * (saturation * model.phases.water_density + (1.0 - saturation) * model.phases.ice_density);
}

// Ratio r at which the top of the column is at the depth of the sliding mass above its base [m]:
//   e + (e/8) sum of r^j, j = 1 to 12 = depth,   within 1 <= r <= full.
// For depths at least that of the column of ratio `full`, r is exactly `full`. For depths below 2.5 e, r is 1: all
// cells have the same height, and the column is higher than the sliding mass. The sum is convex in r; Newton's
// iteration therefore descends from `full` to the root without passing it.
inline THAWSLIDE_HD double cell_growth_below(double depth, double thickness, double full) {
  constexpr int most_iterations = 50;
  constexpr double close = 1e-15;
  const double cells = ColumnCells::band * (depth / thickness - 1.0);  // required value of the sum
  double growth = full;
  THAWSLIDE_ROLLED for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double sum = 0, slope = 0;
    THAWSLIDE_ROLLED for (int j = 0; j < ColumnCells::above; ++j) {
      slope = slope * growth + sum;
      sum = sum * growth + 1.0;
    }
    slope = slope * growth + sum;
    sum *= growth;
    const double step = (sum - cells) / slope;
    if (!(step > close)) {
      break;
    }
    growth -= step;
    if (growth <= 1.0) {
      return min(1.0, full);
    }
  }
  return growth;
}

// Cell heights of a column with a band of thickness e. Heights increase by the ratio r above the band, and by a
// separate ratio in the ground. Face f of the sliding mass is the lower one of its cell f; face 0 is the base.
class ColumnGrid {
 public:
  THAWSLIDE_HD ColumnGrid(double thickness, double cell_growth, double ground_cell, double ground_growth) {
    const double cell = thickness / ColumnCells::band;
    face_[0] = 0.0;
    THAWSLIDE_ROLLED for (int f = 1; f <= ColumnCells::band; ++f) { face_[f] = cell * static_cast<double>(f); }
    double height = cell;
    THAWSLIDE_ROLLED for (int f = ColumnCells::band + 1; f <= ColumnCells::slide; ++f) {
      height *= cell_growth;
      face_[f] = face_[f - 1] + height;
    }
    double depth = ground_cell;
    THAWSLIDE_ROLLED for (int k = ColumnCells::ground - 1; k >= 0; --k) {
      height_[k] = depth;
      depth *= ground_growth;
    }
    THAWSLIDE_ROLLED for (int k = 0; k < ColumnCells::slide; ++k) {
      height_[ColumnCells::ground + k] = face_[k + 1] - face_[k];
    }
  }
  [[nodiscard]] THAWSLIDE_HD double face(int f) const { return face_[f]; }  // of the sliding mass, above the base [m]
  [[nodiscard]] THAWSLIDE_HD double height(int cell) const { return height_[cell]; }  // of any cell [m]
  [[nodiscard]] THAWSLIDE_HD double slide_height(int cell) const { return height_[ColumnCells::ground + cell]; }
  [[nodiscard]] THAWSLIDE_HD const double* heights() const { return height_; }

 private:
  double face_[ColumnCells::slide + 1];
  double height_[ColumnCells::all];
};

template <class Curve>
THAWSLIDE_HD ColumnGrid grid_of(const ColumnModel<Curve>& model, double thickness, double cell_growth) {
  return {thickness, cell_growth, model.ground_cell, model.growth};
}
template <class Curve>
THAWSLIDE_HD ColumnGrid grid_of(const ColumnModel<Curve>& model, const BandColumn& column) {
  return grid_of(model, column.thickness, column.cell_growth);
}

}  // namespace thawslide::physics
