#include "sim/block/block_band_column.hpp"

namespace thawslide::sim {

BlockBandColumn::BlockBandColumn(const band::ColumnsModel& model, double thickness, double load, double column_step)
    : model_(model), column_step_(column_step) {
  segment_.position.setZero();
  segment_.normal.setZero();
  segment_.sides.setZero();
  segment_.area = segment_.area_of_column = 1.0;
  band::follow_load(model_, load, model_.largest_thickness, 0.0, segment_);
  band::start_column_of(model_, thickness, segment_);
}

double BlockBandColumn::step(const BlockDrive& drive) {
  band::follow_load(model_, drive.normal_pressure, model_.largest_thickness, drive.dt, segment_);
  segment_.speed = drive.speed;
  segment_.slip = drive.slip;
  const double before = physics::heat_of(segment_.column) + segment_.heat;
  segment_.heat += drive.dt * drive.heat_flux;
  waiting_ += drive.dt;
  if (waiting_ + 0.5 * drive.dt > column_step_) {
    band::step_segment(model_, drive.band_thickness, waiting_, segment_);
    waiting_ = 0.0;
  }
  return physics::heat_of(segment_.column) + segment_.heat - before;
}

BlockBase BlockBandColumn::base(double normal_pressure) const {
  const physics::BandMeans means = band::means_of(model_, segment_);
  return {band::pressure_ratio(means, segment_) * normal_pressure, means.saturation, means.solid_fraction,
          means.temperature};
}

BlockBand BlockBandColumn::band() const {
  const physics::BandMeans means = band::means_of(model_, segment_);
  return {means.temperature, means.saturation, means.pore_pressure};
}

}  // namespace thawslide::sim
