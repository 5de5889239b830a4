// Time step of a basal segment and its column, with load and heat from the contact nodes or from a rigid block.
#pragma once

#include <limits>
#include <variant>

#include "band/basal_segment.hpp"
#include "physics/band_column_step.hpp"
#include "physics/options.hpp"

namespace thawslide::band {

using AnyColumnModel =
    std::variant<physics::ColumnModel<physics::PowerLawCurve>, physics::ColumnModel<physics::LinearCurve>>;

using physics::BandGrowth;

struct ColumnsModel {
  AnyColumnModel column;
  double body_temperature = 0, ground_temperature = 0;  // [C]
  double density = 0;                                   // initial density of the body at its base [kg/m3]
  double load_time = 0;                                 // averaging time of N [s]
  BandGrowth growth = BandGrowth::none;
  double grain_size = 0, inertial_number = 1;  // d [m], I
  double growth_per_slip = 0;
  double mixing_slip = std::numeric_limits<double>::infinity();  // slip over which shear mixes the band [m]
  double rock_density = 0;                                       // rho_S [kg/m3]
  double largest_thickness = 0;                                  // of the band: initial depth of the sliding mass [m]
};

template <int Dim>
physics::BandMeans means_of(const ColumnsModel& model, const BasalSegment<Dim>& segment);

// Stores means and liquid water of the column in the segment, for use until its next step.
template <int Dim>
void keep_means(const ColumnsModel& model, BasalSegment<Dim>& segment);

template <int Dim>
physics::ColumnVolumes volumes_of(const ColumnsModel& model, const BasalSegment<Dim>& segment);

// P over the averaged N, 0 to 1. The basal law uses this ratio times the current N as pore pressure.
template <int Dim>
double pressure_ratio(const physics::BandMeans& means, const BasalSegment<Dim>& segment) {
  return segment.load > 0.0 ? means.pore_pressure / segment.load : 0.0;
}

// Creates a column of the body's material, with a band of this thickness [m], under the segment's load. Its height is
// limited to the flow depth above it.
template <int Dim>
void start_column_of(const ColumnsModel& model, double thickness, BasalSegment<Dim>& segment);

// Updates the averages of normal pressure [Pa], over the model's time, and of the corresponding flow depth [m], over
// ten times that time or the time since the first load.
template <int Dim>
void follow_load(const ColumnsModel& model, double normal_pressure, double depth, double dt,
                 BasalSegment<Dim>& segment);

// Steps the column over `duration` [s], with the pending friction heat and the current area of the segment. thickness:
// prescribed band thickness at the end [m]. Returns the column's budget for the whole area ([J], [kg]).
template <int Dim>
physics::ColumnBudget step_segment(const ColumnsModel& model, double thickness, double duration,
                                   BasalSegment<Dim>& segment);

// Merges another segment into a segment: sums of area, heat and water, and area-weighted means of everything else.
// Position and shape do not change. Returns the budget of both columns ([J], [kg]) for the change to a common cell
// growth.
template <int Dim>
physics::ColumnBudget merge_from(const ColumnsModel& model, const BasalSegment<Dim>& other, BasalSegment<Dim>& segment);

}  // namespace thawslide::band
