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
physics::ColumnVolumes<Real> volumes_of(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& piece) {
  return std::visit([&](const auto& column) { return physics::column_volumes(column, piece.load, piece.column); },
                    model.column);
}

template <int Dim, class Real>
void start_column_of(const ColumnsModel<Real>& model, Real thickness, BasePiece<Dim, Real>& piece) {
  piece.column = std::visit(
      [&](const auto& column) {
        return physics::start_column(column, thickness, model.body_temperature, model.ground_temperature, piece.load);
      },
      model.column);
}

template <int Dim, class Real>
void follow_load(const ColumnsModel<Real>& model, Real normal_pressure, Real dt, BasePiece<Dim, Real>& piece) {
  const Real share = piece.touched ? -physics::exponential_minus_one(-dt / model.load_time) : Real(1);
  piece.load += share * (std::max(normal_pressure, Real(0)) - piece.load);
  piece.touched = true;
}

template <int Dim, class Real>
physics::ColumnAccount<Real> step_piece(const ColumnsModel<Real>& model, Real thickness, Real duration,
                                        BasePiece<Dim, Real>& piece) {
  constexpr Real largest_share = static_cast<Real>(0.1);  // by which a piece may stretch in one step of its column
  const Real stretch = std::log(piece.area / piece.area_of_column);
  const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(stretch) / largest_share)));
  const Real before = piece.column.thickness, after = next_thickness(model, thickness, piece);
  const Real dt = duration / static_cast<Real>(parts), heat = piece.heat / static_cast<Real>(parts);
  const Real factor = std::exp(stretch / static_cast<Real>(parts));
  physics::ColumnAccount<Real> account;
  for (int part = 1; part <= parts; ++part) {
    piece.area_of_column = part == parts ? piece.area : piece.area_of_column * factor;
    std::visit(
        [&](const auto& column) {
          const physics::ColumnDrive<Real> drive{
              dt,
              piece.load,
              heat / (piece.area_of_column * dt),
              (factor - Real(1)) / dt,
              before + (after - before) * static_cast<Real>(part) / static_cast<Real>(parts),
              -physics::exponential_minus_one(-piece.speed * dt / model.mixing_slip),
              physics::body_enthalpy(column, model.body_temperature),
              physics::water_of_full_pores(column, model.body_temperature)};
          add(physics::step_column(column, drive, piece.column), piece.area_of_column, account);
        },
        model.column);
  }
  piece.heat = Real(0);
  return account;
}

template <int Dim, class Real>
void take_over(const ColumnsModel<Real>& model, const BasePiece<Dim, Real>& other, BasePiece<Dim, Real>& piece) {
  const Real share = piece.area / (piece.area + other.area);
  for (Real BasePiece<Dim, Real>::*const number :
       {&BasePiece<Dim, Real>::slip, &BasePiece<Dim, Real>::speed, &BasePiece<Dim, Real>::load}) {
    piece.*number = share * piece.*number + (Real(1) - share) * other.*number;
  }
  piece.velocity = share * piece.velocity + (Real(1) - share) * other.velocity;
  const Real share_of_column = piece.area_of_column / (piece.area_of_column + other.area_of_column);
  piece.column = std::visit(
      [&](const auto& column) {
        return physics::joined_columns(column, share_of_column, piece.column, other.column, piece.load);
      },
      model.column);
  piece.area += other.area;
  piece.area_of_column += other.area_of_column;
  piece.heat += other.heat;
  piece.touched = piece.touched || other.touched;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template physics::BandMeans<Real> means_of<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&);       \
  template physics::ColumnVolumes<Real> volumes_of<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&); \
  template void take_over<Dim, Real>(const ColumnsModel<Real>&, const BasePiece<Dim, Real>&, BasePiece<Dim, Real>&);   \
  template void start_column_of<Dim, Real>(const ColumnsModel<Real>&, Real, BasePiece<Dim, Real>&);                    \
  template void follow_load<Dim, Real>(const ColumnsModel<Real>&, Real, Real, BasePiece<Dim, Real>&);                  \
  template physics::ColumnAccount<Real> step_piece<Dim, Real>(const ColumnsModel<Real>&, Real, Real,                   \
                                                              BasePiece<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
