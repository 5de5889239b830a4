#include "app/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "app/print.hpp"
#include "app/progress.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"

namespace thawslide::app {

namespace {

// Final position of the front as text.
std::string front_text(double front, double runout) {
  return std::isfinite(front) ? fmt::format("front at {:.0f} m, runout {:.0f} m", front, runout)
                              : "no front: maps.path is not set, and the slide has barely moved";
}

}  // namespace

template <int Dim>
void print_summary(const sim::Simulation<Dim>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                   double wall, const std::filesystem::path& folder) {
  const std::size_t at_start = output.particles_at_start(), at_end = simulation.particles().size();
  print_text("{} particles{}, {} steps in {}: {:.3g} million particle-steps per second on {}{} thread{}\n", at_start,
             at_end == at_start ? "" : fmt::format(", {} of them at the end", at_end), steps, duration_text(wall),
             output.particle_steps() / wall / 1e6, thread_count() == 1 ? "" : "at most ", thread_count(),
             thread_count() == 1 ? "" : "s");
  const sim::HistoryRow row = output.history_row(simulation);
  const auto value = [&](const std::string& name) {
    return std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == name; })->second;
  };
  print_text("{}: mean velocity {:.2f} m/s, mean displacement {:.0f} m, {}\n", sim::when_text(output.end_state()),
             value("mean_velocity_m_s"), value("mean_displacement_m"),
             front_text(value("front_position_m"), value("runout_m")));
  for (const auto& [name, number] : output.figures()) {
    if (std::isfinite(number)) {
      print_text("  {:<30}{:>12}\n", name, rounded_text(number, 4));
    }
  }
  if (simulation.removed().by_guards() > 0) {
    print_text("guards have removed {}\n", sim::text_of(simulation.removed()));
  }
  for (const std::string& warning : output.warnings()) {
    print_text("warning: {}\n", warning);
  }
  print_text("results in {}\n", folder.string());
}

template void print_summary<2>(const sim::Simulation<2>&, const RunOutput<2>&, std::int64_t, double,
                               const std::filesystem::path&);
template void print_summary<3>(const sim::Simulation<3>&, const RunOutput<3>&, std::int64_t, double,
                               const std::filesystem::path&);

}  // namespace thawslide::app
