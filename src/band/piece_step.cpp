#include "band/piece_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"

namespace thawslide::band {

namespace {

template <class Real>
void add(const physics::ColumnAccount<Real>& part, Real area, physics::ColumnAccount<Real>& sum) {
  sum.friction_heat += area * part.friction_heat;
  sum.body_heat += area * part.body_heat;
  sum.ground_heat += area * part.ground_heat;
  sum.vented_heat += area * part.vented_heat;
  sum.steam_heat += area * part.steam_heat;
  sum.body_water += area * part.body_water;
  sum.vented_water += area * part.vented_water;
  sum.steam += area * part.steam;
}

// The thickness [m] that the band of a piece comes to have; what grows is followed by a twentieth a step at most.
template <int Dim, class Real>
Real next_thickness(const ColumnsModel<Real>& model, Real thickness, const BasePiece<Dim, Real>& piece) {
  constexpr Real least_effective = static_cast<Real>(0.02), fastest = static_cast<Real>(1.05);
  const Real now = piece.column.thickness;
  Real wanted = thickness;
  if (model.growth == BandGrowth::slip) {
    wanted = std::max(now, thickness + model.growth_per_slip * piece.slip);
  } else if (model.growth == BandGrowth::inertial && piece.load > Real(0)) {
    const Real effective = std::max(piece.load - means_of(model, piece).pore_pressure, least_effective * piece.load);
    wanted =
        std::max({now, thickness,
                  piece.speed * model.grain_size * std::sqrt(model.rock_density / effective) / model.inertial_number});
  }
  return std::min({std::max(wanted, now / fastest), now * fastest, model.largest_thickness});
}

}  // namespace

template <int Dim, class Real>
physics::BandMeans<Real> means_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece) {
  return std::visit([&](const auto& column) { return physics::band_means(column, piece.load, piece.column); },
                    model.column);
}

template <int Dim, class Real>
void keep_means(const ColumnsModel<Real>& model, BasePiece<Dim, Real>& piece) {
  piece.means = means_of(model, piece);
  piece.liquid =
      std::visit([&](const auto& column) { return physics::liquid_volume(column, piece.column); }, model.column);
}

template <int Dim, class Real>
physics::ColumnVolumes<Real> volumes_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece) {
  return std::visit([&](const auto& column) { return physics::column_volumes(column, piece.load, piece.column); },
                    model.column);
}

template <int Dim, class Real>
void start_column_of(const ColumnsModel<Real>& model, Real thickness, BasePiece<Dim, Real>& piece) {
  piece.column = std::visit(
      [&](const auto& column) {
        return physics::start_column(column, thickness,
                                     physics::cell_growth_below(piece.depth, thickness, column.growth),
                                     model.body_temperature, model.ground_temperature, piece.load);
      },
      model.column);
}

template <int Dim, class Real>
void follow_load(const ColumnsModel<Real>& model, Real normal_pressure, Real depth, Real dt,
                 BasePiece<Dim, Real>& piece) {
  constexpr Real depth_times = 10;  // time over which the depth is averaged, in those of the load
  const Real share = piece.touched ? -physics::exponential_minus_one(-dt / model.load_time) : Real(1);
  piece.load += share * (std::max(normal_pressure, Real(0)) - piece.load);
  piece.loaded_for = piece.touched ? std::min(piece.loaded_for + dt, depth_times * model.load_time) : dt;
  const Real share_of_depth = piece.loaded_for > Real(0) ? dt / piece.loaded_for : Real(1);
  piece.depth += share_of_depth * (std::max(depth, Real(0)) - piece.depth);
  piece.touched = true;
}

template <int Dim, class Real>
physics::ColumnAccount<Real> step_piece(const ColumnsModel<Real>& model, Real thickness, Real duration,
                                        BasePiece<Dim, Real>& piece) {
  piece.depth *= piece.area_of_column / piece.area;  // the slide thins as it stretches; the mean would follow late
  return std::visit(
      [&](const auto& column) {
        const Real next = next_thickness(model, thickness, piece);
        const physics::ColumnChange<Real> change{std::log(piece.area / piece.area_of_column), piece.column.thickness,
                                                 next, piece.column.cell_growth,
                                                 physics::cell_growth_below(piece.depth, next, column.growth)};
        const int parts = physics::parts_of(column, change);
        const Real dt = duration / static_cast<Real>(parts), heat = piece.heat / static_cast<Real>(parts);
        const Real factor = std::exp(change.stretch / static_cast<Real>(parts));
        physics::ColumnAccount<Real> account;
        for (int part = 1; part <= parts; ++part) {
          piece.area_of_column = part == parts ? piece.area : piece.area_of_column * factor;
          const physics::ColumnDrive<Real> drive{dt,
                                                 piece.load,
                                                 heat / (piece.area_of_column * dt),
                                                 (factor - Real(1)) / dt,
                                                 change.thickness_after(part, parts),
                                                 change.cell_growth_after(part, parts),
                                                 -physics::exponential_minus_one(-piece.speed * dt / model.mixing_slip),
                                                 physics::body_enthalpy(column, model.body_temperature),
                                                 physics::water_of_full_pores(column, model.body_temperature)};
          add(physics::step_column(column, drive, piece.column), piece.area_of_column, account);
        }
        piece.heat = Real(0);
        return account;
      },
      model.column);
}

template <int Dim, class Real>
physics::ColumnAccount<Real> take_over(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& other,
                                       BasePiece<Dim, Real>& piece) {
  const Real share = piece.area / (piece.area + other.area);
  for (Real BasePiece<Dim, Real>::*const number :
       {&BasePiece<Dim, Real>::slip, &BasePiece<Dim, Real>::speed, &BasePiece<Dim, Real>::load,
        &BasePiece<Dim, Real>::depth, &BasePiece<Dim, Real>::loaded_for}) {
    piece.*number = share * piece.*number + (Real(1) - share) * other.*number;
  }
  piece.velocity = share * piece.velocity + (Real(1) - share) * other.velocity;
  const Real share_of_column = piece.area_of_column / (piece.area_of_column + other.area_of_column);
  const physics::ColumnAccount<Real> account = std::visit(
      [&](const auto& column) {
        physics::BandColumn<Real> first = piece.column, second = other.column;
        const Real growth = second.cell_growth + share_of_column * (first.cell_growth - second.cell_growth);
        const Real heat = physics::body_enthalpy(column, model.body_temperature);
        const Real water = physics::water_of_full_pores(column, model.body_temperature);
        physics::ColumnAccount<Real> both;
        add(physics::take_cell_growth(column, growth, heat, water, first), piece.area_of_column, both);
        add(physics::take_cell_growth(column, growth, heat, water, second), other.area_of_column, both);
        piece.column = physics::joined_columns(column, share_of_column, first, second, piece.load);
        return both;
      },
      model.column);
  piece.area += other.area;
  piece.area_of_column += other.area_of_column;
  piece.heat += other.heat;
  piece.touched = piece.touched || other.touched;
  return account;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template physics::BandMeans<Real> means_of<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&);       \
  template void keep_means<Dim, Real>(const ColumnsModel<Real>&, BasePiece<Dim, Real>&);                               \
  template physics::ColumnVolumes<Real> volumes_of<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&); \
  template physics::ColumnAccount<Real> take_over<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&,   \
                                                             BasePiece<Dim, Real>&);                                   \
  template void start_column_of<Dim, Real>(const ColumnsModel<Real>&, Real, BasePiece<Dim, Real>&);                    \
  template void follow_load<Dim, Real>(const ColumnsModel<Real>&, Real, Real, Real, BasePiece<Dim, Real>&);            \
  template physics::ColumnAccount<Real> step_piece<Dim, Real>(const ColumnsModel<Real>&, Real, Real,                   \
                                                              BasePiece<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
