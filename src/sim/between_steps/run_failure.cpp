#include "sim/between_steps/run_failure.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "config/case_proposal.hpp"
#include "config/notices.hpp"
#include "physics/mixture.hpp"
#include "sim/maps/path_line.hpp"

namespace thawslide::sim {

namespace {

// A particle faster than this multiple of the body's mean speed has detached from it.
constexpr double runaway = 5.0;

// Below this temperature [C], compression has closed the pores rather than thermal expansion of the rock.
constexpr double hot = 1000.0;

// Advice for a DEM that ends too soon.
constexpr const char* advice_to_recrop =
    "`thawslide new` crops the DEM to the domain: create the case again with a smaller --reach-angle, which uses more "
    "of the DEM, or from a larger DEM.";

// Horizontal direction of a particle's motion as text; x is east and y north.
std::string heading(double x, double y) {
  const double speed = std::hypot(x, y);
  // A component counts if the direction is more than 22.5 degrees from the other axis.
  constexpr double fraction = 0.3826834323650898;
  const std::string along = y > fraction * speed ? "north" : y < -fraction * speed ? "south" : "";
  const std::string across = x > fraction * speed ? "east" : x < -fraction * speed ? "west" : "";
  return along + (along.empty() || across.empty() ? "" : "-") + across;
}

// Axis along which a particle within the domain reaches a side first.
template <int Dim>
int axis_of_exit(const Vector<double, Dim>& position, const Vector<double, Dim>& velocity,
                 const Vector<double, Dim>& extent) {
  int first = 0;
  double soonest = HUGE_VAL;
  for (int a = 0; a < Dim; ++a) {
    const double speed = velocity[a];
    const double ahead = speed > 0.0 ? extent[a] - position[a] : position[a];
    const double time = speed == 0.0 ? HUGE_VAL : ahead / std::abs(speed);
    if (time < soonest) {
      soonest = time;
      first = a;
    }
  }
  return first;
}

// Distance from a position to the edge of the DEM, in the horizontal direction of motion [m].
double distance_to_domain_edge(const config::Site& site, const Point2& position, const Point2& velocity) {
  const double speed = std::hypot(velocity[0], velocity[1]);
  const Raster& ground = *site.ground;
  const auto [low, high] = site.terrain_model.value_or(
      std::array<Point2, 2>{Point2{ground.x, ground.y}, Point2{ground.x_end(), ground.y_end()}});
  double to_edge = HUGE_VAL;
  for (std::size_t a = 0; a < 2; ++a) {
    const double forward = velocity[a] / speed;
    if (forward != 0.0) {
      to_edge = std::min(to_edge, ((forward > 0.0 ? high[a] : low[a]) - position[a]) / forward);
    }
  }
  return std::max(to_edge, 0.0);
}

// Index in memory; ties are broken by the smallest id.
template <int Dim>
std::size_t fastest_particle(const mpm::Particles<Dim>& particles) {
  const auto speed = [&](std::size_t p) { return particles.velocity.template get<Vector<double, Dim>>(p).norm(); };
  std::size_t fastest = 0;
  for (std::size_t p = 1; p < particles.size(); ++p) {
    if (speed(p) > speed(fastest) || (speed(p) == speed(fastest) && particles.id(p) < particles.id(fastest))) {
      fastest = p;
    }
  }
  return fastest;
}

// Failure due to pores closed by heat, if any: their water has no volume left, and its pressure is unbounded.
template <int Dim>
std::string closed_pores(const mpm::Particles<Dim>& particles) {
  std::size_t closed = 0;
  double hottest = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    double temperature = 0.0;  // current and previous temperature, if finite
    for (const double one : {particles.temperature(p), particles.previous_temperature(p)}) {
      temperature = std::max(temperature, one);
    }
    hottest = std::max(hottest, temperature);
    closed += particles.porosity(p) <= physics::smallest_porosity && temperature > hot ? 1u : 0u;
  }
  if (closed == 0) {
    return "";
  }
  return fmt::format(
      "Likely cause: the pores of {} particles have closed, and the pressure of their water has no bound (hottest "
      "particle: {} C). Rock that expands with heat (Eq. 6) fills its pores at some thousand degrees; rock melts "
      "nowhere in the model, and water boils in band columns alone. A thicker band, less basal.heat_fraction or less "
      "cohesion keep it cooler.",
      closed, rounded_text(hottest, 3));
}

// Failure of water without an outlet in pores that compression has nearly closed, if any: nothing bounds its pressure.
template <int Dim>
std::string compressed_pores(const mpm::Particles<Dim>& particles) {
  double smallest = 1.0;  // volume relative to that at t = 0
  bool is_closed = false;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto ratio = particles.volume(p) / particles.initial_volume(p);
    is_closed = is_closed || ratio < 1.0 - 0.9 * particles.initial_porosity(p);
    smallest = std::min(smallest, ratio);
  }
  return is_closed ? fmt::format(
                         "Likely cause: an impact has compressed a particle to {:.2f} of its volume, which "
                         "closes its pores, and the pressure of their water has no bound. Set "
                         "pressure.skeleton_compressibility to its default, 2e-9 1/Pa.",
                         smallest)
                   : "";
}

}  // namespace

void fail_run(const Clock& clock, const std::string& why) {
  throw RunError(fmt::format("the run failed at t = {:.6g} s (step {}): {}", clock.time, clock.step_number, why));
}

template <int Dim>
std::string text_of_left_slide(const Clock& clock, double mass) {
  return fmt::format(
      "the whole slide has left the domain or the known terrain at t = {:.6g} s (step {}). mass_kg still includes the "
      "last {} kg{}, which left in this step. Specify a larger domain ([grid] min and max) or a larger DEM, and repeat "
      "the run.",
      clock.time, clock.step_number, rounded_text(mass, 3), Dim == 2 ? " per m of width" : "");
}

template <int Dim>
Vector<double, Dim> position_of(const Model<Dim>& model, const mpm::Particles<Dim>& particles, std::size_t p) {
  return particles.position.template get<Vector<double, Dim>>(p) + model.origin;
}

template <int Dim>
std::string FailureText<Dim>::name_of(std::size_t p) const {
  const Vector<double, Dim> position = position_of(setup_.model, particles_, p);
  std::string numbers;
  for (int a = 0; a < Dim; ++a) {
    numbers += fmt::format("{}{}", a == 0 ? "" : ", ", coordinate_text(position[a]));
  }
  return fmt::format("particle {} of body '{}' at ({}) m", particles_.id(p),
                     setup_.model.body_names[static_cast<std::size_t>(particles_.body(p))], numbers);
}

template <int Dim>
std::string FailureText<Dim>::fault_text(std::size_t p, mpm::Fault fault) const {
  const auto ratio = particles_.volume(p) / particles_.initial_volume(p);
  const config::Guards& guards = setup_.parameters.guards;
  switch (fault) {
    case mpm::Fault::volume_not_finite:
      return "its volume is not a finite number";
    case mpm::Fault::volume_not_positive:
      return "its volume ratio is not positive";
    case mpm::Fault::volume_too_small:
      return fmt::format("its volume is {:.3g} of that at t = 0, where guards.smallest_volume allows {:g}", ratio,
                         guards.smallest_volume);
    case mpm::Fault::volume_too_large:
      return fmt::format("its volume is {:.3g} of that at t = 0, where guards.largest_volume allows {:g}", ratio,
                         guards.largest_volume);
    case mpm::Fault::state_not_finite:
      return "its position, stress, temperature or pore pressure is not a finite number";
    case mpm::Fault::left_domain:
      return "it left the domain";
    case mpm::Fault::left_map:
      return "the terrain below it is not known: the DEM ends or has a hole there";
    case mpm::Fault::none:
      break;
  }
  return "nothing is wrong with it";
}

// Stopping distance of a particle by friction, v2/(2 g tan(angle)), compared with the distance to the edge of the DEM.
template <int Dim>
std::string FailureText<Dim>::terrain_ahead(std::size_t p, mpm::Fault fault) const {
  const Vector<double, Dim> velocity = particles_.velocity.template get<Vector<double, Dim>>(p);
  const double gravity = setup_.model.motion.gravity.norm();
  constexpr double angle = config::usual_reach_angle, degree = pi / 180.0, rounded_to = 10.0;
  const double energy_height = velocity.squaredNorm() / (2.0 * gravity);
  const double further = std::ceil(energy_height / std::tan(angle * degree) / rounded_to) * rounded_to;
  const std::string level = fmt::format(
      "With {:g} degrees of friction, the reach angle that `thawslide new` assumes, it would go about {:.0f} m "
      "further on level ground, and more where the ground falls. ",
      angle, further);
  if (Dim == 2 || setup_.site.ground == nullptr || fault == mpm::Fault::left_map) {
    return level;
  }
  const Vector<double, Dim> position = position_of(setup_.model, particles_, p);
  const double to_edge = distance_to_domain_edge(setup_.site, {position[0], position[1]}, {velocity[0], velocity[1]});
  return level + (to_edge <= further
                      ? fmt::format("The DEM ends {:.0f} m ahead of it: it has to be larger, and [grid] with "
                                    "it. {}",
                                    to_edge, advice_to_recrop)
                      : fmt::format("The DEM ends {:.0f} m ahead of it: widen [grid] that way.", to_edge));
}

template <int Dim>
bool FailureText<Dim>::is_too_soft(std::size_t p) const {
  const std::string& material = setup_.model.material_names[static_cast<std::size_t>(particles_.material(p))];
  return setup_.parameters.materials.at(material).youngs_modulus < config::softest_modulus;
}

template <int Dim>
std::string FailureText<Dim>::step_to_halve() const {
  return setup_.parameters.time.stepping == config::Stepping::fixed ? "time.step" : "time.safety";
}

template <int Dim>
std::string FailureText<Dim>::cause_in_material(std::size_t p) const {
  const std::string& material = setup_.model.material_names[static_cast<std::size_t>(particles_.material(p))];
  if (is_too_soft(p)) {
    return fmt::format(
        "Likely cause: material '{}' is too soft (youngs_modulus {:g} Pa) and collapses under its own weight. Typical "
        "values for broken rock and ice are 1e7 Pa or more.",
        material, setup_.parameters.materials.at(material).youngs_modulus);
  }
  const bool blends = setup_.parameters.mechanics.transfer == config::Transfer::blend;
  return fmt::format(
      "Likely cause: the step is too long for the material, the material is too soft for its load, or it has "
      "separated. Try half of {}, a larger viscosity_number or viscosity_time of the material, or {}.",
      step_to_halve(),
      blends ? "a larger mechanics.pic_fraction" : "mechanics.transfer = \"blend\" with mechanics.pic_fraction = 0.02");
}

template <int Dim>
std::string FailureText<Dim>::likely_cause(std::size_t p, mpm::Fault fault) const {
  const std::string too_long = cause_in_material(p);
  if (is_too_soft(p)) {
    return too_long;
  }
  const bool pressurized = setup_.model.band.heat && setup_.model.band.pressure;
  if (fault == mpm::Fault::state_not_finite && pressurized) {
    const bool is_rigid = setup_.parameters.pressure.skeleton_compressibility == 0.0;
    const std::string compressed = is_rigid ? compressed_pores(particles_) : "";
    const std::string closed = compressed.empty() ? closed_pores(particles_) : compressed;
    return closed.empty() ? too_long : closed;
  }
  const auto velocity = particles_.velocity.template get<Vector<double, Dim>>(p);
  const double own = velocity.norm();
  const std::string towards = Dim == 2 ? "" : " towards the " + heading(velocity[0], velocity[1]);
  if (fault == mpm::Fault::left_map) {
    return fmt::format("It moves at {} m/s{}. {}", rounded_text(own, 3), towards, terrain_ahead(p, fault)) +
           "Give a DEM that reaches further there, and [grid] with it, or set grid.leaving = \"remove\" to remove such "
           "particles. " +
           advice_to_recrop;
  }
  if (fault != mpm::Fault::left_domain) {
    return too_long;
  }
  const double mean = std::sqrt(2.0 * (sums_.kinetic / sums_.mass));
  const std::string speeds = fmt::format("It moves at {} m/s{}, the slide at {} m/s on average. ", rounded_text(own, 3),
                                         towards, rounded_text(mean, 3));
  if (own > runaway * mean) {
    return fmt::format(
        "{}Likely cause: it detached from the flow; try half of {}, or a larger viscosity_number or viscosity_time of "
        "the material.",
        speeds, step_to_halve());
  }
  const std::string too_far = speeds + "Likely cause: the slide ran further than [grid] min and max allow";
  const int exit_axis = axis_of_exit<Dim>(particles_.position.template get<Vector<double, Dim>>(p), velocity,
                                          setup_.model.constraints.extent);
  if (Dim == 2) {
    return too_far + "; widen them in its direction.";
  }
  if (exit_axis == Dim - 1) {
    return too_far + (velocity[exit_axis] > 0.0 ? "; widen them upwards." : "; widen them downwards.");
  }
  return too_far + ". " + terrain_ahead(p, fault) + (setup_.site.ground ? "" : "Widen [grid] that way.");
}

template <int Dim>
std::string FailureText<Dim>::of_particle(const mpm::InvalidParticle& invalid) const {
  const std::size_t p = slide_.index_of(invalid.id);
  return fmt::format("{}: {}. {}", name_of(p), fault_text(p, invalid.fault), likely_cause(p, invalid.fault));
}

template <int Dim>
std::string FailureText<Dim>::of_removed(const std::string& removed, double fraction,
                                         const mpm::InvalidParticle& last) const {
  return fmt::format(
      "[guards] has removed {}, {:.3g} % of all mass, where guards.removed_mass allows {:g} %; among the last: {}",
      removed, 100.0 * fraction, 100.0 * setup_.parameters.guards.removed_mass, of_particle(last));
}

template <int Dim>
std::string FailureText<Dim>::of_energy(double energy, double fraction) const {
  const std::size_t fastest = fastest_particle(particles_);
  const std::string cause =
      setup_.parameters.basal.distance_check || !setup_.model.ground || is_too_soft(fastest)
          ? cause_in_material(fastest)
          : "Likely cause: without basal.distance_check the terrain acts up to a cell early, and falling material "
            "rebounds with more energy than it had. Set it to true.";
  return fmt::format(
      "energy grew by {:.3g} J{} without a physical cause, {:.3g} % of all energy so far (guards.energy_growth allows "
      "{:g} %). The fastest particle, {}, moves at {} m/s, the slide at {} m/s on average. {}",
      energy, Dim == 2 ? " per m of width" : "", 100.0 * fraction, 100.0 * setup_.parameters.guards.energy_growth,
      name_of(fastest).substr(std::string("particle ").size()),
      rounded_text(particles_.velocity.template get<Vector<double, Dim>>(fastest).norm(), 3),
      rounded_text(std::sqrt(2.0 * (sums_.kinetic / sums_.mass)), 3), cause);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                           \
  template std::string text_of_left_slide<Dim>(const Clock&, double);                                        \
  template Vector<double, Dim> position_of<Dim>(const Model<Dim>&, const mpm::Particles<Dim>&, std::size_t); \
  template class FailureText<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
