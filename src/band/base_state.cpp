#include "band/base_state.hpp"

#include "base/instances.hpp"
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

}  // namespace

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
  template std::vector<double> numbers_of<Dim>(const BaseColumns<Dim>&); \
  template void restore<Dim>(const std::vector<double>&, BaseColumns<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
