#include "run/setup.hpp"

#include <utility>

#include "base/error.hpp"
#include "config/notices.hpp"
#include "sim/checks/body_warnings.hpp"
#include "sim/checks/unresolved_terrain.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/setup/domain_bottom.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/dem.hpp"
#include "gis/roughness.hpp"
#include "gis/site.hpp"
#include "sim/direction.hpp"
#endif

namespace thawslide::run {

template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings) {
  const config::Case& parameters = simulation.parameters();
  warnings.add(sim::warning_of_map_cell(parameters, simulation.site()));
  warnings.add(config::notices(parameters));
  warnings.add(sim::note_of_bottom(parameters, simulation.site()));
  warnings.add(sim::body_warnings(parameters, bodies));
  warnings.add(sim::warning_of_bodies_apart(simulation));
  warnings.add(sim::warnings_of_unresolved_terrain(simulation, bodies));
}

template void add_setup_warnings<2>(const sim::Simulation<2>&, const std::vector<sim::BodyFigures>&, Warnings&);
template void add_setup_warnings<3>(const sim::Simulation<3>&, const std::vector<sim::BodyFigures>&, Warnings&);

std::string warning_line(const std::string& text) { return (text.rfind("note: ", 0) == 0 ? "" : "warning: ") + text; }

void Warnings::add(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (observer_ != nullptr) {
    observer_->text(warning_line(text));
  }
  all_.push_back(text);
}

void Warnings::add(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    add(text);
  }
}

config::Site read_map_files(const config::Case& parameters, [[maybe_unused]] Warnings& warnings) {
  if (parameters.terrain.kind != config::TerrainKind::dem) {
    return {};
  }
#ifdef THAWSLIDE_WITH_GIS
  gis::SiteAndWarnings read = gis::load_site(parameters);
  warnings.add(read.warnings);
  warnings.add(gis::warnings_of_holes(parameters, read.site));
  warnings.add(sim::orient_lines(parameters, read.site));
  warnings.add(sim::warning_of_path(parameters, read.site));
  warnings.add(gis::roughness_warning(parameters, read.site));
  return std::move(read.site);
#else
  throw UserError(
      "{}: terrain.type is \"dem\", and this build of thawslide cannot read maps: it was made without GDAL. Install "
      "libgdal-dev and build again (`./run --setup`), or use a profile.",
      config::location_of(parameters, "terrain.type"));
#endif
}

}  // namespace thawslide::run
