// A column through the base of a slide: ground, shear band and the body above it, per area of the base. It stands on the
// piece of base that it belongs to and moves with it. Its cells lie along the normal; those of the band share its true
// thickness e, those above and below grow with the distance from it.
//
//   heat      d(A H)/dt = A [eta tau v (over e) - div q_T] + what comes in,    q_T = -k grad T
//   water     d(A w)/dt = -A div (rho_L q) + what comes in - steam,             q = -(k_L/gamma_w) grad P
//   pressure  S_s P = theta + m_v (N - N_thaw) + S_s P_thaw, kept within 0 <= P <= N
//             theta = w/(rho_L dz) - n + integral of beta_m dT from Tref        water less pore space
//             S_s = n/K_L + m_v
// H is the enthalpy [J/m2] and w the ice and water [kg/m2] of a cell, A the area of the piece. A cell whose water needs
// more room than there is at P = N lifts the slide (opening); one whose water does not fill its pores has P = 0 and a
// void. Both follow from w, so that no water is lost. Melting makes a void: n (1 - rho_I/rho_L) of the volume.
// Where matter is frozen, P = 0 and nothing seeps. On thawing P starts at P_thaw = max(0, N - s0) less what the void
// takes. As the piece stretches, or the band grows, the cells take in what lies above them; the body gives the rest.
#pragma once

#include <cmath>

#include "physics/boiling.hpp"
#include "physics/enthalpy.hpp"
#include "physics/mixture.hpp"

namespace thawslide::physics {

// Cells from the deepest in the ground upwards.
struct ColumnCells {
  static constexpr int ground = 6, band = 8, above = 12;
  static constexpr int slide = band + above;
  static constexpr int all = ground + slide;
};

// What becomes of water at the upper end of the thawed part.
enum class ThawedEnd { sealed, vented };

template <class Real, class Curve>
struct ColumnModel {
  Phases<Real> phases;
  Curve curve;
  bool latent = true, conduction = true, seepage = true, steam = true;
  bool pressurization = true;             // P of melted matter; off: P = 0
  Real porosity = 0;                      // n
  Real hydraulic_conductivity = 0;        // k_L [m/s]
  Real skeleton_compressibility = 0;      // m_v [1/Pa]
  Real residual_stress = 0;               // s0 [Pa], infinite: no excess pressure on thawing
  WaterExpansion<Real> water_expansion;   // beta_L(T)
  ThawedEnd thawed_end = ThawedEnd::sealed;
  Real ground_conductivity = 0;           // [W/m/K]
  Real ground_capacity = 0;               // [J/m3/K]
  Real ground_cell = 0;                   // height of the ground's first cell [m]
};

template <class Real>
struct BandColumn {
  Real thickness;                        // of the band, e [m]
  Real heat[ColumnCells::all];           // H [J/m2]
  Real temperature[ColumnCells::all];    // [C], of H
  Real water[ColumnCells::slide];        // w [kg/m2]
  Real reference[ColumnCells::slide];    // S_s P_thaw - m_v N_thaw of melted cells
  Real pressure[ColumnCells::slide];     // P [Pa]
  bool melted[ColumnCells::slide];
};

// What happens to a column in a step.
template <class Real>
struct ColumnDrive {
  Real dt;                  // [s]
  Real normal_pressure;     // N [Pa]
  Real heat_flux;           // eta tau v [W/m2]
  Real stretching;          // dA/dt / A [1/s]
  Real thickness;           // of the band at the end of the step [m]
  Real body_heat;           // enthalpy of what comes in at the top [J/m3]
  Real body_water;          // its ice and water [kg/m3]
};

// What a column got and gave in a step, per area at its end.
template <class Real>
struct ColumnAccount {
  Real friction_heat = 0, body_heat = 0, vented_heat = 0, steam_heat = 0;  // [J/m2]
  Real body_water = 0, vented_water = 0, steam = 0;                        // [kg/m2]
};

// Height of face f over the base, of a band of thickness e; f = 0 is the base, those of the ground lie below.
template <class Real>
THAWSLIDE_HD Real face_of_slide(int f, Real thickness) {
  const Real cell = thickness / ColumnCells::band;
  if (f <= ColumnCells::band) {
    return cell * static_cast<Real>(f);
  }
  constexpr Real growth = static_cast<Real>(1.4);
  Real height = thickness, next = cell;
  for (int k = ColumnCells::band; k < f; ++k) {
    next *= growth;
    height += next;
  }
  return height;
}
