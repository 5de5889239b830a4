#include "sim/solver/time_step.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

// Safety factors of the limits named next to each (docs/theory.md, "Stability limits"). The factor of the wave limit
// was measured on resting and sliding blocks with 2 particles per cell and axis. Diffusion was stable at 0.99 of the
// textbook limit.
constexpr double wave_fraction = 1.0;       // of cell / P-wave speed, with viscosity as in wave_limit
constexpr double apic_fraction = 0.75;      // of the wave limit where viscosity rules, with APIC: unstable at 0.8
constexpr double particle_fraction = 0.5;   // of cell / particle speed: a particle may not skip a node
constexpr double diffusion_fraction = 1.0;  // of length^2 / (2 Dim diffusivity)

// Wave speeds [m/s]: elastic, from the current stiffness; viscous, from viscosity, which also acts on opened material.
struct WaveSpeeds {
  double elastic, viscous;
};

// Maximum step that resolves a wave of speed c on cells h. Kelvin-Voigt viscosity of time tau adds damping that an
// explicit step must resolve too: dt^2 c^2/h^2 + dt tau c_v^2/h^2 <= 1, as measured. The textbook formula has twice the
// second term and would refuse stable steps.
double wave_limit(double cell, const WaveSpeeds& speeds, double viscosity_time) {
  const double frequency = speeds.elastic / cell;
  const double damping = viscosity_time * (speeds.viscous / cell) * (speeds.viscous / speeds.elastic);
  return (std::sqrt(1.0 + damping * damping / 4.0) - damping / 2.0) / frequency;
}

// True if that step is less than half of the step without viscosity.
bool viscosity_rules(double cell, const WaveSpeeds& speeds, double viscosity_time) {
  return wave_limit(cell, speeds, viscosity_time) < 0.5 * wave_limit(cell, speeds, 0.0);
}

// Text on the cause of a material's wave limit.
std::string wave_text(const std::string& material, double cell, const std::string& on_cells, const WaveSpeeds& speeds,
                      double viscosity_time) {
  if (viscosity_rules(cell, speeds, viscosity_time)) {
    return fmt::format("the viscosity of material '{}' (viscosity_time {} s, at a wave speed of {} m/s) on {}",
                       material, rounded_text(viscosity_time, 3), rounded_text(speeds.viscous, 3), on_cells);
  }
  const std::string viscosity =
      viscosity_time > 0.0 ? fmt::format(", viscosity {} s", rounded_text(viscosity_time, 3)) : "";
  return fmt::format("the elastic wave of material '{}' ({} m/s{}) on {}", material, rounded_text(speeds.elastic, 3),
                     viscosity, on_cells);
}

// Calls take(step [s], kind, id of the limiting particle, text) for every limit; text() describes it.
template <int Dim, class Visit>
void for_limits(const config::Case& parameters, const Model<Dim>& model, double thickness,
                const band::StepExtremes& found, const Visit& visit) {
  // With ground, the thickness of the layers of cells along its normal, where it is steepest.
  const double cell = parameters.grid.cell / std::hypot(1.0, found.slope);
  const auto on_cells = [&] {
    const std::string cells = fmt::format("cells of {} m", parameters.grid.cell);
    return found.slope > round_off
               ? fmt::format("{}, {} m thick across the steepest ground below a particle ({} degrees)", cells,
                             rounded_text(cell, 3), rounded_text(std::atan(found.slope) * 180.0 / pi, 2))
               : cells;
  };
  if (parameters.mechanics.enabled) {
    band::Extreme lightest = found.density, stiffest = found.elastic_density;
    if (model.bed_density > 0.0) {  // entrained material is included from the start
      lightest.lower({model.bed_density});
      stiffest.lower({model.bed_density});
    }
    // Pore pressure and viscosity act across open gaps; elastic stiffness does not.
    const bool pores_push_back = model.motion.effective_stress && model.band.volumetric_term;
    const double of_pores = pores_push_back ? found.pore_stiffness / lightest.value : 0.0;
    for (std::size_t m = 0; m < model.motion.materials.size(); ++m) {
      const auto& material = model.motion.materials[m];
      const auto modulus = material.elastic.p_wave_modulus();
      const double of_skeleton = modulus / stiffest.value;
      const WaveSpeeds speeds{std::sqrt(of_skeleton + of_pores), std::sqrt(modulus / lightest.value + of_pores)};
      const auto viscosity_time = material.viscosity_time;
      const bool is_viscous = viscosity_rules(cell, speeds, viscosity_time);
      const band::Extreme& what = is_viscous || of_pores > of_skeleton ? lightest : stiffest;
      const bool is_viscous_apic = is_viscous && model.motion.transfer == mpm::TransferKind::apic;
      visit((is_viscous_apic ? apic_fraction : wave_fraction) * wave_limit(cell, speeds, viscosity_time),
            is_viscous ? LimitKind::viscosity : LimitKind::wave, what.particle,
            [&] { return wave_text(model.material_names[m], cell, on_cells(), speeds, viscosity_time); });
    }
    if (found.speed.value > 0.0) {
      visit(particle_fraction * cell / found.speed.value, LimitKind::particle_speed, found.speed.particle,
            [&] { return fmt::format("the particle speed of {} m/s", rounded_text(found.speed.value, 3)); });
    }
  }
  if (model.contact.band_columns) {
    return;  // columns are implicit, and particles neither conduct nor seep
  }
  // Heat and pore pressure are resolved on the finer grid of the band.
  const double length = thickness > 0.0 ? std::min(cell, thickness) : cell;
  if (parameters.heat.enabled && parameters.heat.conduction && found.diffusivity.value > 0.0) {
    visit(diffusion_fraction * length * length / (2.0 * Dim * found.diffusivity.value), LimitKind::conduction,
          found.diffusivity.particle,
          [&] { return fmt::format("heat conduction over {} m", rounded_text(length, 3)); });
  }
  if (parameters.pressure.enabled && parameters.pressure.seepage && found.seepage.value > 0.0) {
    visit(diffusion_fraction * length * length / (2.0 * Dim * found.seepage.value), LimitKind::seepage,
          found.seepage.particle, [&] { return fmt::format("seepage over {} m", rounded_text(length, 3)); });
  }
}

}  // namespace

template <int Dim>
band::StepExtremes extremes_of(const Model<Dim>& model, const mpm::Particles<Dim>& particles) {
  constexpr std::size_t of_a_task = 1024;
  const band::ExtremesOfParticle<Dim> of_particle{model.band, model.band.hydraulic(), {model.free_gaps.data()}};
  const std::size_t count = particles.size(), tasks = (count + of_a_task - 1) / of_a_task;
  return parallel_sum<band::StepExtremes>(tasks, [&](std::size_t task, band::StepExtremes& found) {
    for (std::size_t p = task * of_a_task; p < std::min(count, (task + 1) * of_a_task); ++p) {
      found += of_particle(particles, static_cast<std::uint32_t>(p));
    }
  });
}

template <int Dim>
double largest_stable_step(const config::Case& parameters, const Model<Dim>& model, double thickness,
                           const band::StepExtremes& extremes) {
  double smallest = HUGE_VAL;
  for_limits(parameters, model, thickness, extremes,
             [&](double step, LimitKind /*kind*/, std::int64_t /*particle*/, const auto& /*text*/) {
               smallest = std::min(smallest, step);
             });
  return smallest;
}

template <int Dim>
StepLimit step_limit(const config::Case& parameters, const Model<Dim>& model, double thickness,
                     const band::StepExtremes& extremes) {
  StepLimit limit{HUGE_VAL, "no limit"};
  const auto visit = [&](double step, LimitKind kind, std::int64_t particle, const auto& text) {
    if (step < limit.step) {
      limit = {step, text(), kind, particle};
    }
  };
  for_limits(parameters, model, thickness, extremes, visit);
  return limit;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                     \
  template band::StepExtremes extremes_of<Dim>(const Model<Dim>&, const mpm::Particles<Dim>&);                         \
  template double largest_stable_step<Dim>(const config::Case&, const Model<Dim>&, double, const band::StepExtremes&); \
  template StepLimit step_limit<Dim>(const config::Case&, const Model<Dim>&, double, const band::StepExtremes&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
