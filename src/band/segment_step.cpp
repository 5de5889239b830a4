#include "band/segment_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"

namespace thawslide::band {

namespace {

void add(const physics::ColumnBudget& part, double area, physics::ColumnBudget& sum) {
  sum.friction_heat += area * part.friction_heat;
  sum.body_heat += area * part.body_heat;
  sum.ground_heat += area * part.ground_heat;
  sum.vented_heat += area * part.vented_heat;
  sum.steam_heat += area * part.steam_heat;
  sum.body_water += area * part.body_water;
  sum.vented_water += area * part.vented_water;
  sum.steam += area * part.steam;
}

// Next band thickness [m] of a segment; limited to a change of 5 % per step.
template <int Dim>
double next_thickness(const ColumnsModel& model, double thickness, const BasalSegment<Dim>& segment) {
  constexpr double least_effective = 0.02, fastest = 1.05;
  const double now = segment.column.thickness;
  double wanted = thickness;
  if (model.growth == BandGrowth::slip) {
    wanted = std::max(now, thickness + model.growth_per_slip * segment.slip);
  } else if (model.growth == BandGrowth::inertial && segment.load > 0.0) {
    const double effective =
        std::max(segment.load - means_of(model, segment).pore_pressure, least_effective * segment.load);
    wanted = std::max(
        {now, thickness,
         segment.speed * model.grain_size * std::sqrt(model.rock_density / effective) / model.inertial_number});
  }
  return std::min({std::max(wanted, now / fastest), now * fastest, model.largest_thickness});
}

}  // namespace

template <int Dim>
physics::BandMeans means_of(const ColumnsModel& model, const BasalSegment<Dim>& segment) {
  return std::visit([&](const auto& column) { return physics::band_means(column, segment.load, segment.column); },
                    model.column);
}

template <int Dim>
void keep_means(const ColumnsModel& model, BasalSegment<Dim>& segment) {
  segment.means = means_of(model, segment);
  segment.liquid =
      std::visit([&](const auto& column) { return physics::liquid_volume(column, segment.column); }, model.column);
}

template <int Dim>
physics::ColumnVolumes volumes_of(const ColumnsModel& model, const BasalSegment<Dim>& segment) {
  return std::visit([&](const auto& column) { return physics::column_volumes(column, segment.load, segment.column); },
                    model.column);
}

template <int Dim>
void start_column_of(const ColumnsModel& model, double thickness, BasalSegment<Dim>& segment) {
  segment.column = std::visit(
      [&](const auto& column) {
        return physics::start_column(column, thickness,
                                     physics::cell_growth_below(segment.depth, thickness, column.growth),
                                     model.body_temperature, model.ground_temperature, segment.load);
      },
      model.column);
}

template <int Dim>
void follow_load(const ColumnsModel& model, double normal_pressure, double depth, double dt,
                 BasalSegment<Dim>& segment) {
  constexpr double depth_times = 10;  // averaging time of the depth, as a multiple of that of the load
  const double fraction = segment.touched ? -physics::exponential_minus_one(-dt / model.load_time) : 1.0;
  segment.load += fraction * (std::max(normal_pressure, 0.0) - segment.load);
  segment.loaded_for = segment.touched ? std::min(segment.loaded_for + dt, depth_times * model.load_time) : dt;
  const double fraction_of_depth = segment.loaded_for > 0.0 ? dt / segment.loaded_for : 1.0;
  segment.depth += fraction_of_depth * (std::max(depth, 0.0) - segment.depth);
  segment.touched = true;
}

template <int Dim>
physics::ColumnBudget step_segment(const ColumnsModel& model, double thickness, double duration,
                                   BasalSegment<Dim>& segment) {
  segment.depth *=
      segment.area_of_column / segment.area;  // the mass thins as it stretches; the time average would lag behind
  return std::visit(
      [&](const auto& column) {
        const double next = next_thickness(model, thickness, segment);
        const physics::ColumnChange change{std::log(segment.area / segment.area_of_column), segment.column.thickness,
                                           next, segment.column.cell_growth,
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
          add(physics::step_column(column, drive, segment.column), segment.area_of_column, budget);
        }
        segment.heat = 0.0;
        return budget;
      },
      model.column);
}

template <int Dim>
physics::ColumnBudget merge_from(const ColumnsModel& model, const BasalSegment<Dim>& other,
                                 BasalSegment<Dim>& segment) {
  const double fraction = segment.area / (segment.area + other.area);
  for (double BasalSegment<Dim>::*const number :
       {&BasalSegment<Dim>::slip, &BasalSegment<Dim>::speed, &BasalSegment<Dim>::load, &BasalSegment<Dim>::depth,
        &BasalSegment<Dim>::loaded_for}) {
    segment.*number = fraction * segment.*number + (1.0 - fraction) * other.*number;
  }
  segment.velocity = fraction * segment.velocity + (1.0 - fraction) * other.velocity;
  const double fraction_of_column = segment.area_of_column / (segment.area_of_column + other.area_of_column);
  const physics::ColumnBudget budget = std::visit(
      [&](const auto& column) {
        physics::BandColumn first = segment.column, second = other.column;
        const double growth = second.cell_growth + fraction_of_column * (first.cell_growth - second.cell_growth);
        const double heat = physics::body_enthalpy(column, model.body_temperature);
        const double water = physics::water_of_full_pores(column, model.body_temperature);
        physics::ColumnBudget both;
        add(physics::apply_cell_growth(column, growth, heat, water, first), segment.area_of_column, both);
        add(physics::apply_cell_growth(column, growth, heat, water, second), other.area_of_column, both);
        segment.column = physics::joined_columns(column, fraction_of_column, first, second, segment.load);
        return both;
      },
      model.column);
  segment.area += other.area;
  segment.area_of_column += other.area_of_column;
  segment.heat += other.heat;
  segment.touched = segment.touched || other.touched;
  return budget;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template physics::BandMeans means_of<Dim>(const ColumnsModel&, const BasalSegment<Dim>&);                          \
  template void keep_means<Dim>(const ColumnsModel&, BasalSegment<Dim>&);                                            \
  template physics::ColumnVolumes volumes_of<Dim>(const ColumnsModel&, const BasalSegment<Dim>&);                    \
  template physics::ColumnBudget merge_from<Dim>(const ColumnsModel&, const BasalSegment<Dim>&, BasalSegment<Dim>&); \
  template void start_column_of<Dim>(const ColumnsModel&, double, BasalSegment<Dim>&);                               \
  template void follow_load<Dim>(const ColumnsModel&, double, double, double, BasalSegment<Dim>&);                   \
  template physics::ColumnBudget step_segment<Dim>(const ColumnsModel&, double, double, BasalSegment<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
