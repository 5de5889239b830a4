// What a piece of base and its column do in time, whatever brings them load and heat: the contact nodes of a slide, or
// a rigid block.
#pragma once

#include <limits>
#include <variant>

#include "band/base_piece.hpp"
#include "physics/band_column_step.hpp"

namespace thawslide::band {

template <class Real>
using AnyColumnModel = std::variant<physics::ColumnModel<Real, physics::PowerLawCurve<Real>>,
                                    physics::ColumnModel<Real, physics::LinearCurve<Real>>>;

// How the band's thickness e grows beyond what the case gives.
enum class BandGrowth {
  none,
  inertial,  // e = v d sqrt(rho_S/(N - P))/I, with N - P at least 0.02 N
  slip       // in proportion to the slip
};

template <class Real>
struct ColumnsModel {
  AnyColumnModel<Real> column;
  Real body_temperature = 0, ground_temperature = 0;  // [C]
  Real density = 0;                                   // of the body at its base, at the start [kg/m3]
  Real load_time = 0;                                 // over which N is averaged [s]
  BandGrowth growth = BandGrowth::none;
  Real grain_size = 0, inertial_number = 1;  // d [m], I
  Real growth_per_slip = 0;
  Real mixing_slip = std::numeric_limits<Real>::infinity();  // over which shear mixes the band [m]
  Real rock_density = 0;                                     // rho_S [kg/m3]
  Real largest_thickness = 0;                                // of the band: depth of the slide at the start [m]
};

template <int Dim, class Real>
physics::BandMeans<Real> means_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece);

// Stores means and liquid water of the column in the piece, for use until its next step.
template <int Dim, class Real>
void keep_means(const ColumnsModel<Real>& model, BasePiece<Dim, Real>& piece);

template <int Dim, class Real>
physics::ColumnVolumes<Real> volumes_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece);

// P over the averaged N, 0 to 1: times the N of the moment it is the pore pressure that the law of the base sees.
template <int Dim, class Real>
Real pressure_ratio(const physics::BandMeans<Real>& means, const BasePiece<Dim, Real>& piece) {
  return piece.load > Real(0) ? means.pore_pressure / piece.load : Real(0);
}

// A new column of the body's material, with a band of this thickness [m], under the piece's load and no taller than the
// slide is deep above it.
template <int Dim, class Real>
void start_column_of(const ColumnsModel<Real>& model, Real thickness, BasePiece<Dim, Real>& piece);

// Follows a normal pressure [Pa] of this step, averaged over the model's time, and the depth of the slide [m] that
// belongs to it, averaged over ten times that, or since the first load.
template <int Dim, class Real>
void follow_load(const ColumnsModel<Real>& model, Real normal_pressure, Real depth, Real dt,
                 BasePiece<Dim, Real>& piece);

// Steps the column over `duration` [s], at the end of which the case wants a band so thick [m]: with the friction heat
// that waits, and the area that the piece has by now. Returns what it got and gave, whole ([J], [kg]).
template <int Dim, class Real>
physics::ColumnAccount<Real> step_piece(const ColumnsModel<Real>& model, Real thickness, Real duration,
                                        BasePiece<Dim, Real>& piece);

// Gives a piece what another one beside it has: area, heat and water, and by their areas the means of all else. Where
// it lies and what shape it has stays. Returns what both columns got and gave as they came to cells of one ratio,
// whole.
template <int Dim, class Real>
physics::ColumnAccount<Real> take_over(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& other,
                                       BasePiece<Dim, Real>& piece);

}  // namespace thawslide::band
