// Sums over the band columns of the base, and their checkpoint state.
#include <algorithm>
#include <limits>

#include "band/base_sums.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::band {

namespace {

// Calls visit(number) for each number of a segment, in order.
template <int Dim, class Visit>
void for_each_number(BasalSegment<Dim>& segment, const Visit& visit) {
  for (int a = 0; a < Dim; ++a) {
    visit(segment.position[a]);
    visit(segment.normal[a]);
    visit(segment.velocity[a]);
    for (int side = 0; side + 1 < Dim; ++side) {
      visit(segment.sides(a, side));
    }
  }
  for (double* number :
       {&segment.area, &segment.area_of_column, &segment.slip, &segment.speed, &segment.load, &segment.depth,
        &segment.loaded_for, &segment.heat, &segment.column.thickness, &segment.column.cell_growth}) {
    visit(*number);
  }
  for (int k = 0; k < physics::ColumnCells::all; ++k) {
    visit(segment.column.heat[k]);
    visit(segment.column.temperature[k]);
  }
  for (int k = 0; k < physics::ColumnCells::slide; ++k) {
    for (double* numbers :
         {segment.column.water, segment.column.thawing, segment.column.surplus, segment.column.pressure}) {
      visit(numbers[k]);
    }
  }
}

// Water in pores full of melt [kg/m3].
double water_of_full_pores(const ColumnsModel& model) {
  return model.column.visit([](const auto& column) { return column.porosity * column.phases.water_density; });
}

template <int Dim>
physics::ColumnGrid grid_of(const ColumnsModel& model, const BasalSegment<Dim>& segment) {
  return model.column.visit([&](const auto& column) { return physics::grid_of(column, segment.column); });
}

// True if a cell of the band has no water left, as ice or melt.
template <int Dim>
bool is_dry(const BasalSegment<Dim>& segment) {
  const double* water = segment.column.water;
  return std::any_of(water, water + physics::ColumnCells::band, [](double of_cell) { return !(of_cell > 0.0); });
}

}  // namespace

template <int Dim>
ColumnSums sums_of(const BaseColumns<Dim>& columns) {
  const auto segments = columns.segments();
  std::vector<ColumnSums> of_segment(segments.size());
  parallel_for(segments.size(), [&](std::size_t p) {
    const BasalSegment<Dim>& segment = segments[p];
    const physics::ColumnVolumes volumes = volumes_of(columns.model(), segment);
    of_segment[p] = {segment.area,
                     segment.area_of_column * physics::heat_of(segment.column) + segment.heat,
                     segment.heat,
                     segment.area_of_column * physics::water_of(segment.column),
                     segment.area * volumes.opening,
                     segment.area * volumes.gas_void};
  });
  ColumnSums sums;
  for (const ColumnSums& one : of_segment) {
    sums += one;
  }
  return sums;
}

template <int Dim>
BaseMeans means_of(const BaseColumns<Dim>& columns) {
  const auto segments = columns.segments();
  constexpr double wet_fraction = 1e-3;  // of full pores; less water has just seeped in, and boils next
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const double full = water_of_full_pores(columns.model());
  struct Extremes {
    double max_temperature, max_wet_temperature, pressure_ratio;
    bool dry;
  };
  std::vector<Extremes> extremes(segments.size());
  parallel_for(segments.size(), [&](std::size_t p) {
    const BasalSegment<Dim>& segment = segments[p];
    const auto grid = grid_of(columns.model(), segment);
    Extremes& found = extremes[p];
    found = {-celsius_to_kelvin, -celsius_to_kelvin, 0.0, is_dry(segment)};
    for (int k = 0; k < physics::ColumnCells::slide; ++k) {
      const double temperature = segment.column.temperature[physics::ColumnCells::ground + k];
      found.max_temperature = std::max(found.max_temperature, temperature);
      const bool is_wet = segment.column.water[k] > wet_fraction * full * grid.slide_height(k);
      found.max_wet_temperature = is_wet ? std::max(found.max_wet_temperature, temperature) : found.max_wet_temperature;
    }
    const double highest =
        *std::max_element(segment.column.pressure, segment.column.pressure + physics::ColumnCells::slide);
    found.pressure_ratio = segment.load > 0.0 ? std::min(highest / segment.load, 1.0) : 0.0;
  });
  BaseMeans result;
  double area = 0, dry_area = 0, max_temperature = -celsius_to_kelvin, max_wet_temperature = max_temperature;
  for (std::size_t p = 0; p < segments.size(); ++p) {
    const BasalSegment<Dim>& segment = segments[p];
    const physics::BandMeans means = current_means(segment);
    area += segment.area;
    dry_area += extremes[p].dry ? segment.area : 0.0;
    max_temperature = std::max(max_temperature, extremes[p].max_temperature);
    max_wet_temperature = std::max(max_wet_temperature, extremes[p].max_wet_temperature);
    result.temperature += segment.area * means.temperature;
    result.saturation += segment.area * means.saturation;
    result.pore_pressure += segment.area * means.pore_pressure;
    result.load += segment.area * segment.load;
    result.thickness += segment.area * segment.column.thickness;
    result.max_pressure_ratio = std::max(result.max_pressure_ratio, extremes[p].pressure_ratio);
  }
  result.max_temperature = area > 0.0 ? max_temperature : nothing;
  result.max_wet_temperature = area > 0.0 ? max_wet_temperature : nothing;
  result.dry_fraction = area > 0.0 ? dry_area / area : nothing;
  for (double* mean :
       {&result.temperature, &result.saturation, &result.pore_pressure, &result.load, &result.thickness}) {
    *mean = area > 0.0 ? *mean / area : nothing;
  }
  return result;
}

template <int Dim>
std::vector<double> numbers_of(const BaseColumns<Dim>& columns) {
  SegmentsState<Dim> state = columns.state();
  std::vector<double> numbers{static_cast<double>(state.next_id), state.checks_gaps ? 1.0 : 0.0,
                              static_cast<double>(state.segments.size())};
  const auto add = [&](const double& number) { numbers.push_back(number); };
  state.budget.for_each(add);
  for (BasalSegment<Dim>& segment : state.segments) {
    numbers.push_back(static_cast<double>(segment.id));
    numbers.push_back(segment.touched ? 1.0 : 0.0);
    for_each_number(segment, add);
  }
  return numbers;
}

template <int Dim>
void restore(const std::vector<double>& numbers, BaseColumns<Dim>& columns) {
  StateNumbers read(numbers, "band columns");
  SegmentsState<Dim> state;
  std::size_t of_ledger = 0, of_segment = 2;  // number of state entries
  state.budget.for_each([&](double&) { ++of_ledger; });
  BasalSegment<Dim> any;
  for_each_number(any, [&](double&) { ++of_segment; });
  state.next_id = read.whole(largest_whole);
  state.checks_gaps = read.next() != 0.0;
  state.time_since_step = columns.time_since_step();
  state.segments.resize(read.count(of_segment, of_ledger));
  const auto set = [&](double& number) { number = read.next(); };
  state.budget.for_each(set);
  for (BasalSegment<Dim>& segment : state.segments) {
    segment.id = read.whole(state.next_id);
    segment.touched = read.next() != 0.0;
    for_each_number(segment, set);
    keep_means(columns.model(), segment);
  }
  read.expect_end();
  columns.set(state);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                       \
  template ColumnSums sums_of<Dim>(const BaseColumns<Dim>&);             \
  template BaseMeans means_of<Dim>(const BaseColumns<Dim>&);             \
  template std::vector<double> numbers_of<Dim>(const BaseColumns<Dim>&); \
  template void restore<Dim>(const std::vector<double>&, BaseColumns<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
