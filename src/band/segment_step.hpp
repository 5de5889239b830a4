// Time step of a basal segment and its column, with load and heat from the contact nodes or from a rigid block. For
// host and device.
#pragma once

#include <cmath>
#include <limits>

#include "band/basal_segment.hpp"
#include "base/select.hpp"
#include "physics/band_column_step.hpp"
#include "physics/options.hpp"

namespace thawslide::band {

// Model of a column with one of two curves.
struct AnyColumnModel {
  physics::ColumnModel<physics::PowerLawCurve> power_law;
  physics::ColumnModel<physics::LinearCurve> linear;
  bool is_linear = false;

  AnyColumnModel() = default;
  AnyColumnModel(const physics::ColumnModel<physics::PowerLawCurve>& model) : power_law(model) {}
  AnyColumnModel(const physics::ColumnModel<physics::LinearCurve>& model) : linear(model), is_linear(true) {}

  // Calls work(model) with the model of the curve.
  template <class Work>
  THAWSLIDE_HD decltype(auto) visit(const Work& work) const {
    return is_linear ? work(linear) : work(power_law);
  }
};

using physics::BandGrowth;

struct ColumnsModel {
  AnyColumnModel column;
  double body_temperature = 0, ground_temperature = 0;  // [C]
  double density = 0;                                   // initial density of the body at its base [kg/m3]
  double load_time = 0;                                 // averaging time of N [s]
  double step = 0;                                      // time between two steps of the columns [s]
  BandGrowth growth = BandGrowth::none;
  double grain_size = 0, inertial_number = 1;  // d [m], I
  double growth_per_slip = 0;
  double mixing_slip = std::numeric_limits<double>::infinity();  // slip over which shear mixes the band [m]
  double rock_density = 0;                                       // rho_S [kg/m3]
  double largest_thickness = 0;                                  // of the band: initial depth of the sliding mass [m]
};

// Adds the budget of a column per area to that of its area [m2].
THAWSLIDE_HD inline void add_times_area(const physics::ColumnBudget& part, double area, physics::ColumnBudget& sum) {
  sum.friction_heat += area * part.friction_heat;
  sum.body_heat += area * part.body_heat;
  sum.ground_heat += area * part.ground_heat;
  sum.vented_heat += area * part.vented_heat;
  sum.steam_heat += area * part.steam_heat;
  sum.body_water += area * part.body_water;
  sum.vented_water += area * part.vented_water;
  sum.steam += area * part.steam;
}

template <int Dim>
THAWSLIDE_HD physics::BandMeans means_of(const ColumnsModel& model, const BasalSegment<Dim>& segment) {
  return model.column.visit(
      [&](const auto& column) { return physics::band_means(column, segment.load, segment.column); });
}

// Next band thickness [m] of a segment; limited to a change of 5 % per step.
template <int Dim>
THAWSLIDE_HD double next_thickness(const ColumnsModel& model, double thickness, const BasalSegment<Dim>& segment) {
  constexpr double least_effective = 0.02, fastest = 1.05;
  const double now = segment.column.thickness;
  double wanted = thickness;
  if (model.growth == BandGrowth::slip) {
    wanted = max(now, thickness + model.growth_per_slip * segment.slip);
  } else if (model.growth == BandGrowth::inertial && segment.load > 0.0) {
    const double effective = max(segment.load - means_of(model, segment).pore_pressure, least_effective * segment.load);
    const double of_flow =
        segment.speed * model.grain_size * std::sqrt(model.rock_density / effective) / model.inertial_number;
    wanted = max(max(now, thickness), of_flow);
  }
  return min(min(max(wanted, now / fastest), now * fastest), model.largest_thickness);
}

// Stores means and liquid water of the column in the segment, for use until its next step.
template <int Dim>
THAWSLIDE_HD void keep_means(const ColumnsModel& model, BasalSegment<Dim>& segment) {
  segment.means = means_of(model, segment);
  segment.liquid =
      model.column.visit([&](const auto& column) { return physics::liquid_volume(column, segment.column); });
}

template <int Dim>
THAWSLIDE_HD physics::ColumnVolumes volumes_of(const ColumnsModel& model, const BasalSegment<Dim>& segment) {
  return model.column.visit(
      [&](const auto& column) { return physics::column_volumes(column, segment.load, segment.column); });
}

// Means of the column after its last step, with the pore pressure under the present load.
template <int Dim>
THAWSLIDE_HD physics::BandMeans current_means(const BasalSegment<Dim>& segment) {
  physics::BandMeans means = segment.means;
  means.pore_pressure = physics::band_pressure(segment.load, segment.column);
  return means;
}

// Summary of a segment for maps, in the particles' frame.
struct SegmentBelow {
  double x, y, half_x, half_y;           // centre and half widths [m]
  double area;                           // [m2]
  double temperature, pressure, liquid;  // means over the band [C], [Pa]; volume of water per area [m]
};
// One thread per segment.
struct SummarizeSegment {
  const BasalSegment<3>* segments;
  SegmentBelow* summaries;

  THAWSLIDE_HD void operator()(std::size_t p) const {
    const BasalSegment<3>& segment = segments[p];
    const physics::BandMeans means = current_means(segment);
    const Vector<double, 3> half = 0.5 * segment.sides.cwiseAbs().rowwise().sum();
    summaries[p] = {segment.position[0], segment.position[1], half[0],       half[1], segment.area,
                    means.temperature,   means.pore_pressure, segment.liquid};
  }
};

// Creates a column of the body's material, with a band of this thickness [m], under the segment's load. Its height is
// limited to the flow depth above it.
template <int Dim>
THAWSLIDE_HD void start_column_of(const ColumnsModel& model, double thickness, BasalSegment<Dim>& segment) {
  model.column.visit([&](const auto& column) {
    physics::start_column(column, thickness, physics::cell_growth_below(segment.depth, thickness, column.growth),
                          model.body_temperature, model.ground_temperature, segment.load, segment.column);
  });
}

// Updates the averages of normal pressure [Pa], over the model's time, and of the corresponding flow depth [m], over
// ten times that time or the time since the first load.
template <int Dim>
THAWSLIDE_HD void follow_load(const ColumnsModel& model, double normal_pressure, double depth, double dt,
                              BasalSegment<Dim>& segment) {
  constexpr double depth_times = 10;  // averaging time of the depth, as a multiple of that of the load
  const double fraction = segment.touched ? -physics::exponential_minus_one(-dt / model.load_time) : 1.0;
  segment.load += fraction * (max(normal_pressure, 0.0) - segment.load);
  segment.loaded_for = segment.touched ? min(segment.loaded_for + dt, depth_times * model.load_time) : dt;
  const double fraction_of_depth = segment.loaded_for > 0.0 ? dt / segment.loaded_for : 1.0;
  segment.depth += fraction_of_depth * (max(depth, 0.0) - segment.depth);
  segment.touched = true;
}

// Steps the column over `duration` [s], with the pending friction heat and the current area of the segment. thickness:
// prescribed band thickness at the end [m]. Returns the column's budget for the whole area ([J], [kg]).
template <int Dim>
THAWSLIDE_HD physics::ColumnBudget step_segment(const ColumnsModel& model, double thickness, double duration,
                                                BasalSegment<Dim>& segment) {
  segment.depth *=
      segment.area_of_column / segment.area;  // the mass thins as it stretches; the time average would lag behind
  return model.column.visit([&](const auto& column) {
    const double next = next_thickness(model, thickness, segment);
    const physics::ColumnChange change{std::log(segment.area / segment.area_of_column), segment.column.thickness, next,
                                       segment.column.cell_growth,
                                       physics::cell_growth_below(segment.depth, next, column.growth)};
    const int parts = physics::parts_of(column, change);
    const double dt = duration / static_cast<double>(parts), heat = segment.heat / static_cast<double>(parts);
    const double factor = std::exp(change.stretch / static_cast<double>(parts));
    physics::ColumnBudget budget;
    for (int part = 1; part <= parts; ++part) {
      segment.area_of_column = part == parts ? segment.area : segment.area_of_column * factor;
      const physics::ColumnDrive drive{dt,
                                       segment.load,
                                       heat / (segment.area_of_column * dt),
                                       (factor - 1.0) / dt,
                                       change.thickness_after(part, parts),
                                       change.cell_growth_after(part, parts),
                                       -physics::exponential_minus_one(-segment.speed * dt / model.mixing_slip),
                                       physics::body_enthalpy(column, model.body_temperature),
                                       physics::water_of_full_pores(column, model.body_temperature)};
      add_times_area(physics::step_column(column, drive, segment.column), segment.area_of_column, budget);
    }
    segment.heat = 0.0;
    return budget;
  });
}

// Merges another segment into a segment: sums of area, heat and water, and area-weighted means of everything else.
// Position and shape do not change. Returns the budget of both columns ([J], [kg]) for the change to a common cell
// growth.
template <int Dim>
THAWSLIDE_HD physics::ColumnBudget merge_from(const ColumnsModel& model, const BasalSegment<Dim>& other,
                                              BasalSegment<Dim>& segment) {
  const double fraction = segment.area / (segment.area + other.area);
  const auto mean_of = [&](double BasalSegment<Dim>::*number) {
    segment.*number = fraction * segment.*number + (1.0 - fraction) * other.*number;
  };
  mean_of(&BasalSegment<Dim>::slip);
  mean_of(&BasalSegment<Dim>::speed);
  mean_of(&BasalSegment<Dim>::load);
  mean_of(&BasalSegment<Dim>::depth);
  mean_of(&BasalSegment<Dim>::loaded_for);
  segment.velocity = fraction * segment.velocity + (1.0 - fraction) * other.velocity;
  const double fraction_of_column = segment.area_of_column / (segment.area_of_column + other.area_of_column);
  const physics::ColumnBudget budget = model.column.visit([&](const auto& column) {
    physics::BandColumn first = segment.column, second = other.column;
    const double growth = second.cell_growth + fraction_of_column * (first.cell_growth - second.cell_growth);
    const double heat = physics::body_enthalpy(column, model.body_temperature);
    const double water = physics::water_of_full_pores(column, model.body_temperature);
    physics::ColumnBudget both;
    add_times_area(physics::apply_cell_growth(column, growth, heat, water, first), segment.area_of_column, both);
    add_times_area(physics::apply_cell_growth(column, growth, heat, water, second), other.area_of_column, both);
    segment.column = physics::joined_columns(column, fraction_of_column, first, second, segment.load);
    return both;
  });
  segment.area += other.area;
  segment.area_of_column += other.area_of_column;
  segment.heat += other.heat;
  segment.touched = segment.touched || other.touched;
  return budget;
}

// P over the averaged N, 0 to 1. The basal law uses this ratio times the current N as pore pressure.
template <int Dim>
THAWSLIDE_HD double pressure_ratio(const physics::BandMeans& means, const BasalSegment<Dim>& segment) {
  return segment.load > 0.0 ? means.pore_pressure / segment.load : 0.0;
}

}  // namespace thawslide::band
