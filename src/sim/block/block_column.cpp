#include "sim/block/block_column.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "band/new_particles.hpp"
#include "band/stages_on_cpu.hpp"
#include "terrain/near_ground_kernels.hpp"

namespace thawslide::sim {

namespace {

// The sides of the domain exchange no heat, and the flow depth is constant because the body keeps its shape.
band::BandModel<2> of_a_rigid_body(band::BandModel<2> model) {
  std::fill(std::begin(model.at_faces.faces), std::end(model.at_faces.faces), band::HeatFace{});
  model.thickness_each_step = false;
  return model;
}

}  // namespace

BlockColumn::BlockColumn(const band::BandModel<2>& model, const Initial& initial)
    : model_(of_a_rigid_body(model)), grid_(initial.cell), thickness_(initial.thickness) {
  const double row_height = initial.cell / initial.rows_per_cell;
  band::keep_fields(model_, rows_);
  rows_.resize(static_cast<std::size_t>(std::max(1.0, std::round(initial.thickness / row_height))));
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    const double height = (static_cast<double>(p) + 0.5) * row_height;
    const double depth = std::max(0.0, initial.thickness - height);
    rows_.id(p) = static_cast<std::int64_t>(p);
    rows_.material(p) = initial.material;
    rows_.position.set(p, Vector<double, 2>(0.5 * initial.cell, height));
    rows_.volume(p) = rows_.initial_volume(p) = row_height;
    rows_.thermal_scaling(p) = 1.0;
    rows_.in_band(p) = height < initial.cell ? 1 : 0;
    rows_.flow_depth(p) = height < initial.cell ? initial.thickness : depth;
    rows_.temperature(p) = initial.temperature(depth);
    const double saturation =
        model_.with_heat_content([&](const auto& content) { return content.curve.saturation(rows_.temperature(p)); });
    rows_.porosity(p) = rows_.initial_porosity(p) = initial.porosity(depth, saturation);
  }
  band::set_heat_content(model_, rows_);
  set_normal_load(initial.normal_pressure);
  band::set_pore_pressure(model_, rows_);
  grid_.update(rows_, 0);
  flow_depth_.update(grid_, model_, {}, {}, rows_);
  find_base_nodes();
}

void BlockColumn::find_base_nodes() {
  nodes_.momentum.resize(grid_.blocks().size());  // its size is read when heat becomes non-finite
  std::vector<std::uint8_t> is_base(grid_.blocks().size(), 0);
  for (std::size_t b = 0; b < grid_.blocks().size(); ++b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<2>::nodes); ++k) {
      const Vector<double, 2> point = mpm::node_position(grid_, b, k);
      if (point[1] == 0.0 && (point[0] == 0.0 || point[0] == grid_.cell())) {
        base_nodes_.push_back({b, k});
        is_base[b] = 1;
      }
    }
  }
  nodes_.contact.allocate(grid_.blocks().size(), [&](std::size_t b) { return is_base[b] != 0; });
  for (const mpm::NodeAt& node : base_nodes_) {
    std::fill_n(nodes_.contact.of_block(node.block), mpm::Tile<2>::nodes, mpm::RecordsOf<mpm::Contact, 2>::Record{});
  }
}

void BlockColumn::set_normal_load(double normal_pressure) {
  for (std::size_t p = 0; model_.needs_normal_load() && p < rows_.size(); ++p) {
    const double load = normal_pressure * rows_.flow_depth(p) / thickness_;
    rows_.load_change(p) = load - rows_.normal_load(p);
    rows_.normal_load(p) = load;
  }
}

double BlockColumn::step(const BlockDrive& drive) {
  const band::StagesOnCpu<2> stages{grid_, model_, rows_, nodes_};
  stages.rescale_band(drive.band_thickness);
  stages.average_on_grid();
  const double before = heat();
  for (const mpm::NodeAt& node : base_nodes_) {
    nodes_.contact.of_block(node.block)[node.node][mpm::Contact::friction_heat] =
        drive.heat_flux / static_cast<double>(base_nodes_.size());
  }
  stages.conduct_heat(drive.dt, false);
  if (model_.pressure) {
    set_normal_load(drive.normal_pressure);
    stages.drain_pore_pressure(flow_depth_, drive.dt);
  }
  return heat() - before;
}

double BlockColumn::heat() const {
  double sum = 0.0;
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    sum += rows_.heat_content(p) * rows_.initial_volume(p) / rows_.thermal_scaling(p);
  }
  return sum;
}

BlockBase BlockColumn::base(double /*normal_pressure*/) const {
  BlockBase base{};
  double weights = 0.0;
  for (std::uint32_t p = 0; p < rows_.size(); ++p) {
    const double weight = std::max(0.0, 1.0 - rows_.position(p, 1) / grid_.cell());
    weights += weight;
    base.pore_pressure += weight * rows_.pore_pressure(p);
    base.temperature += weight * rows_.temperature(p);
    base.saturation += weight * rows_.liquid_saturation(p);
    base.solid_fraction +=
        weight * terrain::basal_solid_fraction(model_.phases, model_.lubrication, rows_, mpm::ScalarIndex{{p}});
  }
  return {base.pore_pressure / weights, base.saturation / weights, base.solid_fraction / weights,
          base.temperature / weights};
}

BlockBand BlockColumn::band() const {
  double count = 0.0;
  BlockBand band{};
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    if (rows_.in_band(p) != 0) {
      count += 1.0;
      band.temperature += rows_.temperature(p);
      band.saturation += rows_.liquid_saturation(p);
      band.pore_pressure += rows_.pore_pressure(p);
    }
  }
  return {band.temperature / count, band.saturation / count, band.pore_pressure / count};
}

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
