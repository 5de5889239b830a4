#include "sim/block/block.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "exec/cpu.hpp"
#include "physics/contact.hpp"
#include "sim/block/block_column.hpp"
#include "sim/direction.hpp"
#include "sim/setup/bodies.hpp"
#include "sim/setup/initial_state.hpp"
#include "sim/setup/model.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/solver/time_step.hpp"

namespace thawslide::sim {

namespace {

// Conversion between x and path length along the ground, and the direction of the ground, which is constant between two
// of its points; coordinates relative to the domain's lower corner [m].
class Path {
 public:
  explicit Path(const Model<2>& model) : x_(model.profile->x()) {
    const std::vector<double>& heights = model.profile->heights();
    length_.push_back(0.0);
    for (std::size_t k = 1; k < x_.size(); ++k) {
      const double run = x_[k] - x_[k - 1], rise = heights[k] - heights[k - 1];
      length_.push_back(length_.back() + std::hypot(run, rise));
      angle_.push_back(std::atan(rise / run));
      normal_.push_back(Vector<double, 2>(rise, -run).normalized());
    }
  }
  [[nodiscard]] double length_at(double x) const { return map(x_, length_, segment(x_, x), x); }
  [[nodiscard]] const Vector<double, 2>& normal_at(double x) const { return normal_[segment(x_, x)]; }
  [[nodiscard]] double x_at(double length) const { return map(length_, x_, segment(length_, length), length); }

  // Position on the path. A search begins at the segment of the last one, because lengths usually ascend.
  class Position {
   public:
    Position(const Path& path, double length) : path_(path), segment_(segment(path.length_, length)), length_(length) {}
    void move_to(double length) {
      const std::vector<double>& lengths = path_.length_;
      length_ = length;
      while (segment_ + 2 < lengths.size() && lengths[segment_ + 1] <= length) {
        ++segment_;
      }
      while (segment_ > 0 && lengths[segment_] > length) {
        --segment_;
      }
    }
    [[nodiscard]] double x() const { return map(path_.length_, path_.x_, segment_, length_); }
    [[nodiscard]] double angle() const { return path_.angle_[segment_]; }                      // of the slope
    [[nodiscard]] const Vector<double, 2>& normal() const { return path_.normal_[segment_]; }  // into the ground

   private:
    const Path& path_;
    std::size_t segment_;
    double length_;
  };

 private:
  static std::size_t segment(const std::vector<double>& from, double value) {
    return static_cast<std::size_t>(std::upper_bound(from.begin() + 1, from.end() - 1, value) - from.begin()) - 1;
  }
  static double map(const std::vector<double>& from, const std::vector<double>& to, std::size_t k, double value) {
    return to[k] + (value - from[k]) / (from[k + 1] - from[k]) * (to[k + 1] - to[k]);
  }

  std::vector<double> x_, length_;         // of each point
  std::vector<double> angle_;              // of each segment
  std::vector<Vector<double, 2>> normal_;  // of each segment
};

// A vertical slice of the body.
struct Slice {
  double path;  // along the ground at t = 0 [m]
  double mass;  // [kg per m of width]
  double base;  // length of ground under it [m]
};

struct Slices {
  std::vector<Slice> all;
  double mass = 0, base = 0;
  double thickness = 0;  // mean, normal to the ground [m]
  double middle_x = 0;   // absolute coordinate
};

Slices make_slices(const config::Case& parameters, const Model<2>& model, const Path& path,
                   const mpm::Particles<2>& particles) {
  const double cell = parameters.grid.cell;
  std::map<long, std::pair<double, double>> columns;  // by cell number: mass, volume
  for (std::size_t p = 0; p < particles.size(); ++p) {
    auto& column = columns[static_cast<long>(std::floor(particles.position(p, 0) / cell))];
    column.first += particles.mass(p);
    column.second += particles.volume(p);
  }
  Slices slices;
  double volume = 0.0;
  for (const auto& [number, column] : columns) {
    const double x = (static_cast<double>(number) + 0.5) * cell;
    const double base = cell / model.ground->slope_cosine(Vector<double, 1>(x), cell);
    slices.all.push_back({path.length_at(x), column.first, base});
    slices.mass += column.first;
    slices.base += base;
    volume += column.second;
    slices.middle_x += x * column.first;
  }
  slices.thickness = volume / slices.base;
  slices.middle_x = slices.middle_x / slices.mass + model.origin[0];
  return slices;
}

struct Forces {
  double along = 0, normal = 0;  // forces along the ground towards +x, and into the ground [N per m of width]
};

// speed: of the slices along the curved ground [m/s].
Forces forces_on_slices(const Model<2>& model, const Path& path, const Slices& slices, double displacement,
                        double speed) {
  Forces forces;
  // Averages curvature over at least the thickness, because the slide bridges shorter bends. Spans shorter than a slice
  // would miss part of a kink.
  const double first = slices.all.front().path + displacement;
  Path::Position middle(path, first), ahead(path, first), behind(path, first);
  for (const Slice& slice : slices.all) {
    const double along = slice.path + displacement, span = std::max(slice.base, slices.thickness);
    middle.move_to(along);
    ahead.move_to(along + 0.5 * span);
    behind.move_to(along - 0.5 * span);
    const double curvature = (ahead.angle() - behind.angle()) / span;  // positive where the ground is concave
    const Vector<double, 2>& normal = middle.normal();
    const Vector<double, 2> tangent(-normal[1], normal[0]);  // towards +x
    forces.along += slice.mass * model.motion.gravity.dot(tangent);
    forces.normal += physics::load_in_bend(slice.mass, model.motion.gravity.dot(normal), speed, curvature);
  }
  return forces;
}

// Rigid block of slices with its column, advanced step by step.
class Block {
 public:
  Block(const config::Case& parameters, Table valley_factor, const std::optional<BlockStart>& given,
        const Model<2>& model, const mpm::Particles<2>& particles)
      : parameters_(parameters),
        model_(model),
        path_(model),
        valley_factor_(std::move(valley_factor)),
        slices_(make_slices(parameters, model, path_, particles)),
        column_(make_column(particles.material(0))) {
    const auto& start = parameters.bodies.begin()->second.velocity;
    const Vector<double, 2> into = path_.normal_at(slices_.middle_x - model.origin[0]);
    velocity_ = -start[0] * into[1] + start[1] * into[0];  // along the ground
    const std::vector<BodyAtStart> bodies = bodies_at_start(model, particles, parameters.grid.cell);
    direction_ = direction_of(bodies, {});
    up_ = -model.motion.gravity.normalized();
    const BlockStart extent = given ? *given : extent_of(bodies.front(), particles);
    rear_ = on_ground((direction_ > 0.0 ? extent.from : extent.to) - model.origin[0]);
    top_ = extent.top - up_.dot(Vector<double, 2>(model.origin[0], model.origin[1]));
  }

  void step(double dt) {
    if (is_held(model_.release_times, time_, 0)) {
      time_ += dt;
      return;
    }
    const Forces forces = evaluate_base();
    const double trial = slices_.mass * velocity_ + dt * forces.along;
    const auto impulse = physics::contact_impulse(dt * forces.normal, std::abs(trial), base_area_, dt, strength_);
    const double old_velocity = velocity_;
    velocity_ = (trial - std::copysign(impulse.tangential, trial)) / slices_.mass;
    const double middle = 0.5 * (old_velocity + velocity_);
    const double work = impulse.slides ? impulse.tangential / base_area_ * std::abs(middle) : 0.0;
    const double heat = model_.contact.law.heat_fraction * work;
    friction_work_ += work;
    friction_heat_ += heat;
    displacement_ += middle * dt;
    slip_ += impulse.slides ? std::abs(middle) * dt : 0.0;
    const BlockDrive drive{heat / dt, basal_.state.normal_pressure,         std::abs(middle),
                           slip_,     parameters_.band.thickness.at(time_), dt};
    heat_gain_ += std::visit([&](auto& column) { return column.step(drive); }, column_);
    time_ += dt;
  }

  [[nodiscard]] double time() const { return time_; }

  HistoryRow row() {
    const Forces forces = evaluate_base();
    const BlockBand band = std::visit([](const auto& column) { return column.band(); }, column_);
    const Slice& foremost = direction_ > 0.0 ? slices_.all.back() : slices_.all.front();
    const Vector<double, 2> front =
        on_ground(path_.x_at(foremost.path + displacement_) + 0.5 * direction_ * parameters_.grid.cell);
    const Vector<double, 2> onward(direction_ * up_[1], -direction_ * up_[0]);
    return {{"time_s", time_},
            {"velocity_m_s", direction_ * velocity_},
            {"displacement_m", direction_ * displacement_},
            {"front_position_m", front[0] + model_.origin[0]},
            {"travel_distance_m", onward.dot(front - rear_)},
            {"drop_height_m", top_ - up_.dot(front)},
            {"normal_pressure_Pa", basal_.state.normal_pressure},
            {"pore_pressure_Pa", basal_.state.pore_pressure},
            {"sliding_strength_Pa", strength_},
            {"driving_traction_Pa", direction_ * forces.along / base_area_},
            {"band_temperature_C", band.temperature},
            {"band_saturation", band.saturation},
            {"band_pore_pressure_Pa", band.pore_pressure},
            {"band_friction_coefficient", friction_},
            {"friction_work_J_m2", friction_work_},
            {"friction_heat_J_m2", friction_heat_},
            {"heat_gain_J_m2", heat_gain_},
            {"valley_factor", base_area_ / slices_.base}};
  }

 private:
  using AnyColumn = std::variant<BlockColumn, BlockBandColumn>;

  // Point of the ground at x; both relative to the domain's lower corner [m].
  [[nodiscard]] Vector<double, 2> on_ground(double x) const { return {x, model_.profile->height(x)}; }

  [[nodiscard]] BlockStart extent_of(const BodyAtStart& body, const mpm::Particles<2>& particles) const {
    double top = -HUGE_VAL;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vector<double, 2> position(particles.position(p, 0) + model_.origin[0],
                                       particles.position(p, 1) + model_.origin[1]);
      top = std::max(top, up_.dot(position));
    }
    return {body.lower, body.upper, top};
  }

  [[nodiscard]] AnyColumn make_column(std::int32_t material) const {
    const BlockColumn::Initial rows = initial_column(material);
    if (!model_.contact.band_columns) {
      return AnyColumn(std::in_place_type<BlockColumn>, model_.band, rows);
    }
    const double temperature = rows.temperature(rows.thickness);
    const double saturation =
        model_.band.with_heat_content([&](const auto& content) { return content.curve.saturation(temperature); });
    const double conductivity = model_.band.hydraulic_conductivity[static_cast<std::size_t>(material)];
    const ColumnMaterial of_column{temperature, rows.porosity(rows.thickness, saturation), conductivity,
                                   rows.thickness};
    return AnyColumn(std::in_place_type<BlockBandColumn>, make_columns_model(parameters_, model_, of_column),
                     parameters_.band.thickness.at(time_), rows.normal_pressure, parameters_.band.column_step);
  }

  [[nodiscard]] BlockColumn::Initial initial_column(std::int32_t material) const {
    const config::Body& body = parameters_.bodies.begin()->second;
    const auto seed_at = [this](double depth) {
      return Seed<2>{0, Vector<double, 2>(slices_.middle_x, 0.0), depth, 0.0};
    };
    return {slices_.thickness,
            parameters_.grid.cell,
            forces_on_slices(model_, path_, slices_, 0.0, 0.0).normal / slices_.base,
            body.particles_per_axis,
            material,
            [&, seed_at](double depth) { return initial_temperature(model_, body, nullptr, seed_at(depth)); },
            [&, seed_at](double depth, double saturation) {
              return initial_porosity(body, nullptr, seed_at(depth), saturation);
            }};
  }

  // Evaluates the basal law for the current state, averaged over the ground below the slices; returns the forces on
  // them.
  Forces evaluate_base() {
    const terrain::BasalLaw& law = model_.contact.law;
    const double speed_in_bends = parameters_.block.bends ? velocity_ : 0.0;
    const Forces forces = forces_on_slices(model_, path_, slices_, displacement_, speed_in_bends);
    const std::vector<double> fractions = place_slices();
    basal_.area = 1.0;
    basal_.state.time = time_;
    basal_.state.normal_pressure = forces.normal / slices_.base;
    const BlockBase base =
        std::visit([&](const auto& column) { return column.base(basal_.state.normal_pressure); }, column_);
    basal_.state.pore_pressure = model_.contact.pore_pressure ? base.pore_pressure : 0.0;
    basal_.state.temperature = base.temperature;
    basal_.state.saturation = base.saturation;
    basal_.state.solid_fraction = base.solid_fraction;
    basal_.state.slip = slip_;
    basal_.state.speed = std::abs(velocity_);
    basal_.state.unit_weight = law.gravity * slices_.mass / (slices_.thickness * slices_.base);
    strength_ = friction_ = 0.0;
    for (std::size_t number = 0; number < fractions.size(); ++number) {
      if (fractions[number] > 0.0) {
        basal_.substrate = static_cast<int>(number);
        evaluate_basal_law(cpu_, law, &basal_, 1);
        strength_ += fractions[number] * basal_.strength(law.clamp, law.cap_pressure);
        friction_ += fractions[number] * basal_.friction;
      }
    }
    return forces;
  }

  // Sums the base area at the current position; returns the fraction of the mass on each substrate, by its number.
  [[nodiscard]] std::vector<double> place_slices() {
    std::vector<double> fractions(model_.substrates ? model_.contact.law.grounds.size() : 1, 0.0);
    Path::Position position(path_, slices_.all.front().path + displacement_);
    base_area_ = 0.0;
    for (const Slice& slice : slices_.all) {
      position.move_to(slice.path + displacement_);
      const double x = position.x();
      base_area_ += slice.base * valley_factor_.at(x + model_.origin[0]);
      fractions[model_.substrates ? static_cast<std::size_t>(model_.substrates->at(x, 0.0)) : 0] += slice.mass;
    }
    for (double& fraction : fractions) {
      fraction /= slices_.mass;
    }
    return fractions;
  }

  const config::Case& parameters_;
  const Model<2>& model_;
  Path path_;
  Table valley_factor_;  // over absolute x
  Slices slices_;
  double time_ = 0, velocity_ = 0, displacement_ = 0, slip_ = 0;  // along the ground, towards +x
  double direction_ = 1;         // +1 or -1: direction along x in which output is positive
  Vector<double, 2> up_, rear_;  // against gravity; rear end at t = 0, on the ground [m]
  double top_ = -HUGE_VAL;       // height of the highest particle at t = 0, along up_ [m]
  AnyColumn column_;
  exec::Cpu cpu_;
  terrain::BasalNode basal_;
  double base_area_ = 0;                // ground below the slices, including the valley factor [m2 per m of width]
  double strength_ = 0, friction_ = 0;  // current basal strength [Pa]; mu_e
  double friction_work_ = 0, friction_heat_ = 0, heat_gain_ = 0;
};

}  // namespace

void require_one_body(const config::Case& parameters) {
  if (parameters.bodies.size() > 1) {
    throw UserError(fmt::format("{}: the block model slides one body, and the case has {}. Use `thawslide run`.",
                                parameters.file, parameters.bodies.size()));
  }
}

std::vector<HistoryRow> run_block(const config::Case& parameters, const config::Site& site, Table valley_factor,
                                  const std::optional<BlockStart>& start) {
  if (parameters.general.dimension != 2 || parameters.terrain.kind == config::TerrainKind::none) {
    throw UserError(
        fmt::format("{}: the block model slides a 2D section along a terrain, or a 3D case on a DEM. "
                    "Give case.dimension = 2 and a terrain.type other than \"none\", or use `thawslide run`.",
                    parameters.file));
  }
  if (parameters.bed.law != config::BedLaw::none) {
    throw UserError(fmt::format("{}: the block model does not entrain a bed. Remove [bed], or use `thawslide run`.",
                                config::location_of(parameters, "bed.law")));
  }
  if (parameters.general.width.varies()) {
    throw UserError(
        fmt::format("{}: the block model has one width. Give case.width as a number, or use `thawslide run`.",
                    config::location_of(parameters, "case.width")));
  }
  require_one_body(parameters);
  const Model<2> model = make_model<2>(parameters, site);
  mpm::Particles<2> particles;
  fill_bodies(parameters, site, model, particles);
  Block block(parameters, std::move(valley_factor), start, model, particles);
  const StepLimit limit =
      step_limit(parameters, model, parameters.band.thickness.smallest(), extremes_of(model, particles));
  double dt = parameters.time.step;
  if (parameters.time.stepping == config::Stepping::adaptive) {
    dt = std::min(dt, parameters.time.safety * limit.step);
  } else if (dt > limit.step) {
    throw UserError(
        fmt::format("{}: time.step is {} s, above the limit of {:.3g} s set by {}. Use a smaller time.step.",
                    config::location_of(parameters, "time.step"), dt, rounded_down(limit.step, 3), limit.what));
  }
  const double interval = std::max(parameters.time.history_interval, dt);
  const auto steps = static_cast<long>(std::ceil(parameters.time.end / dt * (1.0 - 1e-12)));
  const long every = std::max(1L, std::lround(interval / dt));
  const ThreadScope alone(1);  // waking other threads for one column takes longer than its step
  std::vector<HistoryRow> rows{block.row()};
  for (long k = 1; k <= steps; ++k) {
    block.step(dt);
    if (k % every == 0 || k == steps) {
      rows.push_back(block.row());
    }
  }
  return rows;
}

}  // namespace thawslide::sim
