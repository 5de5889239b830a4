#include "sim/time_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::sim {

namespace {

// Shares of the limits named beside each (docs/theory.md, "Stability limits"). The wave's was measured on resting and
// sliding blocks with 2 particles a cell and axis; diffusion at 0.99 of the textbook limit was seen to be stable.
constexpr double wave_share = 1.0;       // of cell / P-wave speed, with viscosity as in wave_limit
constexpr double particle_share = 0.5;   // of cell / particle speed: a particle may not pass a node unseen
constexpr double diffusion_share = 1.0;  // of length^2 / (2 Dim diffusivity)

// The step at which a wave of speed c is resolved on cells h. Kelvin-Voigt viscosity of time tau adds damping that an
// explicit step must resolve too: dt^2 c^2/h^2 + dt tau c^2/h^2 <= 1, as measured (the textbook has twice the second
// term and would refuse steps that run without trouble).
double wave_limit(double cell, double speed, double viscosity_time) {
  const double frequency = speed / cell;
  const double damping = viscosity_time * frequency;
  return (std::sqrt(1.0 + damping * damping / 4.0) - damping / 2.0) / frequency;
}

// Whether that step is less than half of what it would be without viscosity.
bool viscosity_rules(double cell, double speed, double viscosity_time) {
  return wave_limit(cell, speed, viscosity_time) < 0.5 * wave_limit(cell, speed, 0.0);
}

// What sets the limit by a material's wave, in words.
std::string wave_text(const std::string& material, double cell, double speed, double viscosity_time) {
  if (viscosity_rules(cell, speed, viscosity_time)) {
    return fmt::format(
        "the viscosity of material '{}' (viscosity_time {} s, at a wave speed of {:.4g} m/s) on cells of {} m",
        material, viscosity_time, speed, cell);
  }
  const std::string viscosity = viscosity_time > 0.0 ? fmt::format(", viscosity {} s", viscosity_time) : "";
  return fmt::format("the elastic wave of material '{}' ({:.4g} m/s{}) on cells of {} m", material, speed, viscosity,
                     cell);
}

// An extreme of some numbers, and the place in memory of the particle that it is of.
struct Extreme {
  static constexpr std::size_t no_particle = ~std::size_t{0};
  double value = 0.0;
  std::size_t particle = no_particle;

  void raise(double other, std::size_t p) {
    if (other > value) {
      *this = {other, p};
    }
  }
  void lower(double other, std::size_t p) {
    if (other < value) {
      *this = {other, p};
    }
  }
};

// What of the particles sets limits.
struct Extremes {
  Extreme density{HUGE_VAL};  // smallest [kg/m3]
  Extreme speed;              // largest [m/s]
  Extreme diffusivity;        // largest, of heat [m2/s]
  Extreme seepage;            // largest diffusivity of pore pressure [m2/s]
  double pore_stiffness = 0;  // largest [Pa]
};

template <int Dim, class Real>
Extremes extremes_of(const Model<Dim, Real>& model, const mpm::Particles<Dim, Real>& particles) {
  Extremes found;
  if (model.bed_density > Real(0)) {
    found.density.value = static_cast<double>(model.bed_density);  // what is taken up of it counts from the start
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    found.density.lower(static_cast<double>(particles.mass(p) / particles.volume(p)), p);
    double speed2 = 0.0;
    for (int a = 0; a < Dim; ++a) {
      speed2 += static_cast<double>(particles.velocity(p, a) * particles.velocity(p, a));
    }
    found.speed.raise(std::sqrt(speed2), p);
    const Real porosity = particles.initial_porosity(p);
    const Real saturation = particles.liquid_saturation(p);
    found.diffusivity.raise(static_cast<double>(physics::conductivity(model.motion.phases, porosity, saturation) /
                                                physics::heat_capacity(model.motion.phases, porosity, saturation)),
                            p);
    const Real storing = physics::storing_porosity(model.motion.phases, porosity, model.band.skeleton_compressibility);
    found.pore_stiffness = std::max(
        found.pore_stiffness, static_cast<double>(physics::pore_stiffness(model.motion.phases, storing, Real(1))));
    const auto material = static_cast<std::size_t>(particles.material(p));
    found.seepage.raise(static_cast<double>(physics::hydraulic_diffusivity(
                            model.motion.phases, storing, Real(1), model.band.hydraulic_conductivity[material])),
                        p);
  }
  if (!model.motion.effective_stress || !model.band.volumetric_term) {
    found.pore_stiffness = 0.0;  // the pore does not push back
  }
  return found;
}

// Calls take(step [s], kind, place in memory of the particle that sets it, text) for every limit; text() says what it
// is.
template <int Dim, class Real, class Take>
void for_limits(const config::Case& parameters, const Model<Dim, Real>& model, double thickness,
                const mpm::Particles<Dim, Real>& particles, const Take& take) {
  const double cell = parameters.grid.cell;
  const Extremes found = extremes_of(model, particles);
  if (parameters.mechanics.enabled) {
    for (std::size_t m = 0; m < model.motion.materials.size(); ++m) {
      const auto& material = model.motion.materials[m];
      const double modulus = static_cast<double>(material.elastic.p_wave_modulus()) + found.pore_stiffness;
      const double speed = std::sqrt(modulus / found.density.value);
      const auto viscosity_time = static_cast<double>(material.viscosity_time);
      const bool is_viscous = viscosity_rules(cell, speed, viscosity_time);
      take(wave_share * wave_limit(cell, speed, viscosity_time), is_viscous ? LimitKind::viscosity : LimitKind::wave,
           found.density.particle, [&] { return wave_text(model.material_names[m], cell, speed, viscosity_time); });
    }
    if (found.speed.value > 0.0) {
      take(particle_share * cell / found.speed.value, LimitKind::particle_speed, found.speed.particle,
           [&] { return fmt::format("the particle speed of {:.4g} m/s", found.speed.value); });
    }
  }
  if (model.contact.band_columns) {
    return;  // columns are implicit, and particles neither conduct nor seep
  }
  // Heat and pore pressure see the finer grid of the band.
  const double scaled = thickness * (cell / static_cast<double>(model.largest_layer));
  const double length = thickness > 0.0 ? std::min(cell, scaled) : cell;
  if (parameters.heat.enabled && parameters.heat.conduction && found.diffusivity.value > 0.0) {
    take(diffusion_share * length * length / (2.0 * Dim * found.diffusivity.value), LimitKind::conduction,
         found.diffusivity.particle, [&] { return fmt::format("heat conduction over {:.4g} m", length); });
  }
  if (parameters.pressure.enabled && parameters.pressure.seepage && found.seepage.value > 0.0) {
    const double pore_length = model.band.seepage_as_printed ? std::sqrt(cell * length) : length;
    take(diffusion_share * pore_length * pore_length / (2.0 * Dim * found.seepage.value), LimitKind::seepage,
         found.seepage.particle, [&] { return fmt::format("seepage over {:.4g} m", pore_length); });
  }
}

}  // namespace

template <int Dim, class Real>
double largest_stable_step(const config::Case& parameters, const Model<Dim, Real>& model, double thickness,
                           const mpm::Particles<Dim, Real>& particles) {
  double smallest = HUGE_VAL;
  for_limits(parameters, model, thickness, particles,
             [&](double step, LimitKind /*kind*/, std::size_t /*particle*/, const auto& /*text*/) {
               smallest = std::min(smallest, step);
             });
  return smallest;
}

template <int Dim, class Real>
StepLimit step_limit(const config::Case& parameters, const Model<Dim, Real>& model, double thickness,
                     const mpm::Particles<Dim, Real>& particles) {
  StepLimit limit{HUGE_VAL, "no limit"};
  const auto take = [&](double step, LimitKind kind, std::size_t p, const auto& text) {
    if (step < limit.step) {
      limit = {step, text(), kind, p == Extreme::no_particle ? -1 : particles.id(p)};
    }
  };
  for_limits(parameters, model, thickness, particles, take);
  return limit;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                               \
  template double largest_stable_step<Dim, Real>(const config::Case&, const Model<Dim, Real>&, double, \
                                                 const mpm::Particles<Dim, Real>&);                    \
  template StepLimit step_limit<Dim, Real>(const config::Case&, const Model<Dim, Real>&, double,       \
                                           const mpm::Particles<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
