// What a piece of base and its column do in time, whatever brings them load and heat: the contact nodes of a slide, or
// a rigid block.
#pragma once

#include <limits>
#include <variant>

#include "band/basal_segment.hpp"
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
physics::BandMeans<Real> means_of(const ColumnsModel<Real>& model, const BasalSegment<Dim, Real>& segment);

// Stores means and liquid water of the column in the piece, for use until its next step.
template <int Dim, class Real>
void keep_means(const ColumnsModel<Real>& model, BasalSegment<Dim, Real>& segment);

template <int Dim, class Real>
physics::ColumnVolumes<Real> volumes_of(const ColumnsModel<Real>& model, const BasalSegment<Dim, Real>& segment);

// P over the averaged N, 0 to 1: times the N of the moment it is the pore pressure that the law of the base sees.
template <int Dim, class Real>
Real pressure_ratio(const physics::BandMeans<Real>& means, const BasalSegment<Dim, Real>& segment) {
  return segment.load > Real(0) ? means.pore_pressure / segment.load : Real(0);
}

// A new column of the body's material, with a band of this thickness [m], under the piece's load and no taller than the
// slide is deep above it.
template <int Dim, class Real>
void start_column_of(const ColumnsModel<Real>& model, Real thickness, BasalSegment<Dim, Real>& segment);

// Follows a normal pressure [Pa] of this step, averaged over the model's time, and the depth of the slide [m] that
// belongs to it, averaged over ten times that, or since the first load.
template <int Dim, class Real>
void follow_load(const ColumnsModel<Real>& model, Real normal_pressure, Real depth, Real dt,
                 BasalSegment<Dim, Real>& segment);

// Steps the column over `duration` [s], at the end of which the case wants a band so thick [m]: with the friction heat
// that waits, and the area that the piece has by now. Returns what it got and gave, whole ([J], [kg]).
template <int Dim, class Real>
physics::ColumnAccount<Real> step_segment(const ColumnsModel<Real>& model, Real thickness, Real duration,
                                          BasalSegment<Dim, Real>& segment);

// Gives a piece what another one beside it has: area, heat and water, and by their areas the means of all else. Where
// it lies and what shape it has stays. Returns what both columns got and gave as they came to cells of one ratio,
// whole.
template <int Dim, class Real>
physics::ColumnAccount<Real> merge_from(const ColumnsModel<Real>& model, const BasalSegment<Dim, Real>& other,
                                        BasalSegment<Dim, Real>& segment);

}  // namespace thawslide::band
