#include "sim/records/end_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

// What has reduced growth in trials (benchmarks/decisions/viscosity.md), among what the case does not have yet.
std::string remedy_of_growth(const config::Case& parameters) {
  const auto any = [&](const auto& has) {
    return std::any_of(parameters.materials.begin(), parameters.materials.end(),
                       [&](const auto& named) { return has(named.second); });
  };
  if (any([](const config::Material& material) { return material.dilation_angle > 0.0; })) {
    return "Set a smaller dilation_angle of the materials.";
  }
  if (any([](const config::Material& material) { return !material.gaps_close_first; })) {
    return "Set gaps_close_first = true for the materials.";
  }
  if (parameters.mechanics.transfer != config::Transfer::apic) {
    return "Set mechanics.transfer = \"apic\".";
  }
  return "Use a smaller grid.cell, or a larger viscosity_number of the materials.";
}

}  // namespace

template <int Dim>
EndState end_state(const Simulation<Dim>& simulation, bool slide_left) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const config::Case& parameters = simulation.parameters();
  const double width = parameters.general.width.factor();
  EndState state;
  state.time = simulation.time();
  state.rest_rule = simulation.rest_rule();
  state.left_particles = simulation.removed().left;
  const Budget<Dim>& budget = simulation.budget();
  state.left_mass = width * budget.left_mass;
  state.guarded_mass = width * budget.removed_mass;
  state.whole_mass = width * (budget.initial_mass + budget.joined_mass);
  if (slide_left || simulation.device_has_failed() || simulation.particle_count() == 0) {
    state.rest_since = state.mean_velocity = state.dilation_volume = state.dilation_fraction = unknown;
    return state;
  }
  const BodySums<Dim> sums = simulation.sum_over_body();
  state.is_known = parameters.mechanics.enabled;
  state.at_rest = state.is_known && simulation.is_at_rest();
  state.has_moved = simulation.moved_mass().has_moved;
  state.rest_since = state.at_rest ? simulation.rest_since() : unknown;
  state.mean_velocity = sums.momentum.norm() / static_cast<double>(sums.mass);
  state.dilation_volume = width * sums.volume_change;
  state.dilation_fraction = sums.volume_change / sums.initial_volume;
  state.dilation_remedy =
      state.dilation_fraction > 0.0 ? remedy_of_growth(parameters) : "Check youngs_modulus of the materials.";
  return state;
}

std::vector<std::pair<std::string, double>> named(const EndState& state) {
  return {{"rest_since_s", state.rest_since},
          {"mean_velocity_m_s", state.mean_velocity},
          {"dilation_volume_m3", state.dilation_volume},
          {"dilation_fraction", state.dilation_fraction},
          {"left_mass_kg", state.left_mass}};
}

std::string when_text(const EndState& state) {
  return fmt::format("at {} s{}", rounded_text(state.time, 4),
                     !state.is_known    ? ""
                     : !state.at_rest   ? ", not at rest"
                     : !state.has_moved ? ", has not moved"
                                        : ", at rest");
}

std::vector<std::string> warnings_of(const EndState& state, bool is_over) {
  std::vector<std::string> warnings;
  if (is_over && state.is_known && !state.at_rest) {
    warnings.push_back(fmt::format(
        "the slide is not at rest at {} s (mean velocity {:.3g} m/s; at rest: {}). Volumes, areas, distances and maps "
        "are those of this time and not of a deposit. Continue with `thawslide resume` and a later --end.",
        rounded_text(state.time, 3), state.mean_velocity, state.rest_rule));
  }
  if (std::abs(state.dilation_fraction) > noticed_dilation) {
    warnings.push_back(
        fmt::format("dilation has changed the volume of the slide by {:+.1f} %, {} m3 (expected: at most {:g} %). "
                    "Thicknesses, areas and volumes are too {} by about as much. {}",
                    100.0 * state.dilation_fraction, rounded_text(state.dilation_volume, 2), 100.0 * noticed_dilation,
                    state.dilation_fraction > 0.0 ? "large" : "small", state.dilation_remedy));
  }
  if (state.left_particles > 0) {
    const double mass = state.left_mass - state.guarded_mass;
    warnings.push_back(
        fmt::format("{} particles have left the domain or the known terrain and were removed: {} kg, {:.3g} % of the "
                    "mass. The results do not include them. Use a larger domain or DEM.",
                    state.left_particles, rounded_text(mass, 3), 100.0 * mass / state.whole_mass));
  }
  return warnings;
}

template EndState end_state<2>(const Simulation<2>&, bool);
template EndState end_state<3>(const Simulation<3>&, bool);

template <int Dim>
NamedNumbers base_table(const Simulation<Dim>& simulation) {
  NamedNumbers table;
  const auto* columns = simulation.band_columns();
  if (columns == nullptr) {
    return table;
  }
  const auto add = [&](const char* name, double number) { table[name].push_back(number); };
  for (const band::BasalSegment<Dim>& segment : columns->segments()) {
    const physics::BandMeans means = band::current_means(segment);
    const double* slide = segment.column.temperature + physics::ColumnCells::ground;
    for (int a = 0; a < 3; ++a) {
      table["position_m"].push_back(a < Dim ? segment.position[a] + simulation.model().origin[std::min(a, Dim - 1)]
                                            : 0.0);
    }
    add("area_m2", segment.area);
    add("thickness_m", segment.column.thickness);
    add("normal_pressure_Pa", segment.load);
    add("pore_pressure_Pa", means.pore_pressure);
    add("temperature_C", means.temperature);
    add("max_temperature_C", *std::max_element(slide, slide + physics::ColumnCells::slide));
    add("liquid_saturation", means.saturation);
    add("opening_m", band::volumes_of(columns->model(), segment).opening);
    add("slip_m", segment.slip);
    add("slip_speed_m_s", segment.speed);
  }
  return table;
}

template NamedNumbers base_table<2>(const Simulation<2>&);
template NamedNumbers base_table<3>(const Simulation<3>&);

}  // namespace thawslide::sim
