// What the columns of a slide's base hold together, and what a checkpoint keeps of them.
#include <algorithm>
#include <limits>

#include "band/base_columns.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::band {

namespace {

// Calls visit(number) with each number of a piece, in order.
template <int Dim, class Real, class Visit>
void for_each_number(BasePiece<Dim, Real>& piece, const Visit& visit) {
  for (int a = 0; a < Dim; ++a) {
    visit(piece.position[a]);
    visit(piece.normal[a]);
    visit(piece.velocity[a]);
    for (int side = 0; side + 1 < Dim; ++side) {
      visit(piece.sides(a, side));
    }
  }
  for (Real* number : {&piece.area, &piece.area_of_column, &piece.slip, &piece.speed, &piece.load, &piece.depth,
                       &piece.loaded_for, &piece.heat, &piece.column.thickness, &piece.column.cell_growth}) {
    visit(*number);
  }
  for (int k = 0; k < physics::ColumnCells::all; ++k) {
    visit(piece.column.heat[k]);
    visit(piece.column.temperature[k]);
  }
  for (int k = 0; k < physics::ColumnCells::slide; ++k) {
    for (Real* numbers : {piece.column.water, piece.column.thawing, piece.column.surplus, piece.column.pressure}) {
      visit(numbers[k]);
    }
  }
}

// Of melt [kg/m3].
template <class Real>
Real water_of_full_pores(const ColumnsModel<Real>& model) {
  return std::visit([](const auto& column) { return column.porosity * column.phases.water_density; }, model.column);
}

template <int Dim, class Real>
physics::ColumnGrid<Real> grid_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece) {
  return std::visit([&](const auto& column) { return physics::grid_of(column, piece.column); }, model.column);
}

// Whether some cell of the band has no water left, as ice or melt.
template <int Dim, class Real>
bool is_dry(const BasePiece<Dim, Real>& piece) {
  const Real* water = piece.column.water;
  return std::any_of(water, water + physics::ColumnCells::band, [](Real of_cell) { return !(of_cell > Real(0)); });
}

}  // namespace

template <int Dim, class Real>
ColumnSums<Real> BaseColumns<Dim, Real>::sums() const {
  std::vector<ColumnSums<Real>> of_piece(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    const Piece& piece = pieces_[p];
    const physics::ColumnVolumes<Real> volumes = volumes_of(piece);
    of_piece[p] = {piece.area,
                   piece.area_of_column * physics::heat_of(piece.column) + piece.heat,
                   piece.heat,
                   piece.area_of_column * physics::water_of(piece.column),
                   piece.area * volumes.opening,
                   piece.area * volumes.gas_void};
  });
  ColumnSums<Real> sums;
  for (const ColumnSums<Real>& one : of_piece) {
    sums += one;
  }
  return sums;
}

template <int Dim, class Real>
BaseMeans<Real> BaseColumns<Dim, Real>::means() const {
  constexpr Real wet_share = static_cast<Real>(1e-3);  // of full pores; less has just seeped in, and boils next
  constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();
  const Real full = water_of_full_pores(model_);
  struct Extremes {
    Real hottest, hottest_wet, pressure_ratio;
    bool dry;
  };
  std::vector<Extremes> extremes(pieces_.size());
  parallel_for(pieces_.size(), [&](std::size_t p) {
    const Piece& piece = pieces_[p];
    const auto grid = grid_of(model_, piece);
    Extremes& found = extremes[p];
    found = {-celsius_to_kelvin<Real>, -celsius_to_kelvin<Real>, Real(0), is_dry(piece)};
    for (int k = 0; k < physics::ColumnCells::slide; ++k) {
      const Real temperature = piece.column.temperature[physics::ColumnCells::ground + k];
      found.hottest = std::max(found.hottest, temperature);
      const bool is_wet = piece.column.water[k] > wet_share * full * grid.slide_height(k);
      found.hottest_wet = is_wet ? std::max(found.hottest_wet, temperature) : found.hottest_wet;
    }
    const Real highest = *std::max_element(piece.column.pressure, piece.column.pressure + physics::ColumnCells::slide);
    found.pressure_ratio = piece.load > Real(0) ? std::min(highest / piece.load, Real(1)) : Real(0);
  });
  BaseMeans<Real> result;
  Real area = 0, dry_area = 0, hottest = -celsius_to_kelvin<Real>, hottest_wet = hottest;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const physics::BandMeans<Real> means = means_now(piece);
    area += piece.area;
    dry_area += extremes[p].dry ? piece.area : Real(0);
    hottest = std::max(hottest, extremes[p].hottest);
    hottest_wet = std::max(hottest_wet, extremes[p].hottest_wet);
    result.temperature += piece.area * means.temperature;
    result.saturation += piece.area * means.saturation;
    result.pore_pressure += piece.area * means.pore_pressure;
    result.load += piece.area * piece.load;
    result.thickness += piece.area * piece.column.thickness;
    result.largest_pressure_ratio = std::max(result.largest_pressure_ratio, extremes[p].pressure_ratio);
  }
  result.hottest = area > Real(0) ? hottest : nothing;
  result.hottest_wet = area > Real(0) ? hottest_wet : nothing;
  result.dry_share = area > Real(0) ? dry_area / area : nothing;
  for (Real* mean : {&result.temperature, &result.saturation, &result.pore_pressure, &result.load, &result.thickness}) {
    *mean = area > Real(0) ? *mean / area : nothing;
  }
  return result;
}

template <int Dim, class Real>
std::vector<double> BaseColumns<Dim, Real>::state() const {
  std::vector<double> numbers{static_cast<double>(next_id_), look_for_gaps_ ? 1.0 : 0.0,
                              static_cast<double>(pieces_.size())};
  ColumnLedger<Real> ledger = ledger_;
  const auto add = [&](const Real& number) { numbers.push_back(static_cast<double>(number)); };
  ledger.for_each(add);
  for (Piece piece : pieces_) {
    numbers.push_back(static_cast<double>(piece.id));
    numbers.push_back(piece.touched ? 1.0 : 0.0);
    for_each_number(piece, add);
  }
  return numbers;
}

template <int Dim, class Real>
void BaseColumns<Dim, Real>::restore(const std::vector<double>& numbers) {
  StateNumbers state(numbers, "band columns");
  std::size_t of_ledger = 0, of_piece = 2;  // how many numbers they take
  ledger_.for_each([&](Real&) { ++of_ledger; });
  Piece any;
  for_each_number(any, [&](Real&) { ++of_piece; });
  next_id_ = state.whole(largest_whole);
  look_for_gaps_ = state.next() != 0.0;
  pieces_.assign(state.count(of_piece, of_ledger), Piece{});
  const auto set = [&](Real& number) { number = static_cast<Real>(state.next()); };
  ledger_.for_each(set);
  for (Piece& piece : pieces_) {
    piece.id = state.whole(next_id_);
    piece.touched = state.next() != 0.0;
    for_each_number(piece, set);
    keep_means(model_, piece);
  }
  state.expect_end();
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                              \
  template ColumnSums<Real> BaseColumns<Dim, Real>::sums() const;     \
  template BaseMeans<Real> BaseColumns<Dim, Real>::means() const;     \
  template std::vector<double> BaseColumns<Dim, Real>::state() const; \
  template void BaseColumns<Dim, Real>::restore(const std::vector<double>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
