#include "app/resolution_text.hpp"

#include <fmt/format.h>

#include "app/progress.hpp"
#include "base/thousands.hpp"
#include "config/resolution.hpp"
#include "config/resolution_preset.hpp"

namespace thawslide::app {

std::string resolution_text(const config::Proposal& proposal, const std::string& chosen, const RunCost& cost) {
  std::string purpose, others;
  for (const config::ResolutionFacts& each : config::resolutions) {
    if (chosen == each.name) {
      purpose = fmt::format("; {}", each.purpose);
      continue;
    }
    const double cell =
        config::cell_of(each.resolution, proposal.thickness, proposal.median_thickness, proposal.particles_per_axis);
    const double seconds = cost.seconds * config::run_time_factor(proposal.cell, cell, 3);
    others += fmt::format("             --resolution {}: cells of {:g} m, about {}; {}\n", each.name, cell,
                          duration_text(seconds), each.purpose);
  }
  return fmt::format(
      "resolution:  {}cells of {:g} m{}\n             about {} particles, {} steps to time.end, and {} on {} "
      "thread{}\n{}",
      chosen.empty() ? "" : chosen + ", ", proposal.cell, purpose, with_commas(proposal.particles, 3),
      with_commas(cost.steps, 3), duration_text(cost.seconds), cost.threads, cost.threads == 1 ? "" : "s", others);
}

}  // namespace thawslide::app
