#include "run/summary.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/rounding.hpp"

namespace thawslide::run {

namespace {

// Key figure of run.json in the summary; per metre of width in 2D without case.width if it is extensive.
struct ShownFigure {
  const char* name;  // in run.json
  const char* label;
  const char* unit;
  double factor = 1.0;
  bool is_extensive = false;
};
constexpr ShownFigure shown_figures[] = {
    {.name = "rest_since_s", .label = "at rest since", .unit = "s"},
    {.name = "dilation_volume_m3", .label = "volume change by dilation", .unit = "m3", .is_extensive = true},
    {.name = "dilation_fraction", .label = "relative volume change", .unit = "%", .factor = 100.0},
    {.name = "left_mass_kg", .label = "mass of removed particles", .unit = "kg", .is_extensive = true},
    {.name = "covered_volume_m3", .label = "covered volume", .unit = "m3"},
    {.name = "covered_area_m2", .label = "covered area", .unit = "m2"},
    {.name = "affected_area_m2", .label = "affected area", .unit = "m2"},
    {.name = "deposit_area_m2", .label = "deposit area", .unit = "m2"},
    {.name = "inundated_area_m2", .label = "inundated area", .unit = "m2"},
    {.name = "front_distance_m", .label = "front position along the path", .unit = "m"},
    {.name = "travel_distance_m", .label = "travel distance", .unit = "m"},
    {.name = "drop_height_m", .label = "drop height", .unit = "m"},
    {.name = "reach_angle_degrees", .label = "reach angle", .unit = "degrees"}};

// Final position of the front as text.
std::string front_text(double front, double runout) {
  return std::isfinite(front) ? fmt::format("front at {:.0f} m, runout {:.0f} m", front, runout)
                              : "no front: maps.path is not set, and the slide has barely moved";
}

}  // namespace

template <int Dim>
void report_summary(const sim::Simulation<Dim>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                    double wall, const std::filesystem::path& folder, Observer& observer) {
  const std::size_t at_start = output.particles_at_start(), at_end = simulation.particles().size();
  observer.line("{} particles{}, {} steps in {}: {:.3g} million particle-steps per second on {}{} thread{}",
                count_text(static_cast<double>(at_start)),
                at_end == at_start ? "" : fmt::format(", {} at the end", count_text(static_cast<double>(at_end))),
                count_text(static_cast<double>(steps)), duration_text(wall), output.particle_steps() / wall / 1e6,
                thread_count() == 1 ? "" : "at most ", thread_count(), thread_count() == 1 ? "" : "s");
  const sim::HistoryRow row = output.history_row(simulation);
  const auto value = [&](const std::string& name) {
    return std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == name; })->second;
  };
  observer.line("{}: mean velocity {:.2f} m/s, mean displacement {:.0f} m, {}", sim::when_text(output.end_state()),
                value("mean_velocity_m_s"), value("mean_displacement_m"),
                front_text(value("front_position_m"), value("runout_m")));
  const bool is_per_metre = Dim == 2 && !(simulation.parameters().general.width.reference() > 0.0);
  for (const auto& figure : output.figures()) {
    const auto* const shown = std::find_if(std::begin(shown_figures), std::end(shown_figures),
                                           [&](const ShownFigure& each) { return figure.first == each.name; });
    if (shown != std::end(shown_figures) && std::isfinite(figure.second)) {
      observer.line("  {:<30}{:>12} {}{}", shown->label, rounded_text(shown->factor * figure.second, 3), shown->unit,
                    is_per_metre && shown->is_extensive ? " per metre of width" : "");
    }
  }
  if (simulation.removed().by_guards() > 0) {
    observer.line("guards have removed {}", sim::text_of(simulation.removed()));
  }
  for (const std::string& warning : output.warnings()) {
    observer.line("warning: {}", warning);
  }
  observer.line("results in {}", folder.string());
}

template void report_summary<2>(const sim::Simulation<2>&, const RunOutput<2>&, std::int64_t, double,
                                const std::filesystem::path&, Observer&);
template void report_summary<3>(const sim::Simulation<3>&, const RunOutput<3>&, std::int64_t, double,
                                const std::filesystem::path&, Observer&);

}  // namespace thawslide::run
