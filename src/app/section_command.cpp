// thawslide section: creates a 2D case, or a profile alone, from a DEM along a line.
#include <algorithm>
#include <filesystem>

#include "app/case_folder.hpp"
#include "app/commands.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/case_proposal.hpp"
#include "config/input_limits.hpp"
#include "io/history_writer.hpp"
#include "sim/block/section.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* profile_name = "profile.csv";
constexpr const char* line_option = "--line";

// File name in a form that fits a line of comments.
std::string name_of(const std::string& file) { return config::shown(name_of_file(file)); }

struct Cut {
  config::ProfileTable profile;
  Point2 begin{}, end{};  // of the line
};

Cut cut_along_line(const config::Site& site, const std::string& line_file) {
  const std::string source = fmt::format("{}: {}", line_option, line_file);
  const Raster& ground = *site.ground;
  const double spacing = 0.5 * std::min(ground.cell_x, ground.cell_y);
  const sim::PathLine line(site.path);
  if (line.empty()) {
    throw UserError("{}: the line has no length. Draw one with two corners apart or more.", source);
  }
  Cut cut{{}, line.corners().front(), line.corners().back()};
  cut.profile.distance = sim::stations_along(line, 0.0, line.length(), spacing);
  cut.profile.terrain = sim::ground_along(line, cut.profile.distance, ground);
  sim::require_known(line, cut.profile.distance, cut.profile.terrain, line.length(), ground, source);
  if (!site.releases.empty()) {
    cut.profile.surface = sim::thickness_along(line, cut.profile.distance, site.releases.at(body_name).thickness);
    for (std::size_t k = 0; k < cut.profile.surface.size(); ++k) {
      cut.profile.surface[k] += cut.profile.terrain[k];
    }
  }
  return cut;
}

// Cell of the case for which the profile is made; `otherwise` without a body.
double cell_of(const config::ProfileTable& profile, double otherwise) {
  if (profile.surface.empty()) {
    return otherwise;
  }
  const config::SurfaceBody body = config::body_on(profile);
  return body.area > 0.0 ? config::propose_section(profile, body).cell : otherwise;
}

// Ground as in a 3D run, with the filter for such cells and the noise of the whole DEM.
config::Site smoothed_site(config::Case trial, double cell) {
  trial.grid.cell = cell;
  trial.terrain.smooth.is_auto = true;
  return reopen_site(trial);
}

std::string format_filter(const SectionOptions& options, const config::Roughness& ground) {
  return fmt::format(
      "{} was smoothed with a standard deviation of {:g} m, as for a 3D run on {:g} m cells whose domain is the whole "
      "DEM. It has noise of {:.2g} m rms and bumps with an rms slope of {:.2g}. Set terrain.smooth = {:g} in a 3D case "
      "with a smaller domain to have the same terrain",
      name_of(options.maps.dem), ground.width, ground.cell, ground.noise, ground.bump_slope, ground.width);
}

// `taper`: of the edges of the excavation [m].
std::vector<std::string> comments_on(const SectionOptions& options, const config::Site& site, const Cut& cut,
                                     double taper) {
  std::vector<std::string> comments{
      fmt::format("Cut by `thawslide section` out of {} along {}: its triangles below the line.",
                  name_of(options.maps.dem), name_of(options.line)),
      fmt::format("From x = {:.10g}, y = {:.10g} to x = {:.10g}, y = {:.10g}{}{}.", cut.begin[0], cut.begin[1],
                  cut.end[0], cut.end[1], site.crs_name.empty() ? "" : " in ", config::shown(site.crs_name))};
  if (!options.maps.release.empty()) {
    comments.push_back(
        options.maps.cut
            ? fmt::format("The surface is that of the DEM; the terrain is lower by the vertical thickness of {}.",
                          name_of(options.maps.release))
            : fmt::format("The terrain is that of the DEM; the surface is higher by the vertical thickness of {}.",
                          name_of(options.maps.release)));
  }
  if (taper > 0.0) {
    comments.push_back(
        fmt::format("The edges of the cut are ramps {:g} m wide, half of it beyond the outline: vertical edges would "
                    "trap the slide.",
                    taper));
  }
  if (site.roughness->width > 0.0) {
    comments.push_back(format_filter(options, *site.roughness) + ".");
  }
  return comments;
}

// Requires that the release lies on the line, with some cells of the domain at both ends.
void check_body(const SectionOptions& options, const config::ProfileTable& profile, const config::SurfaceBody& body,
                const config::Proposal& proposal) {
  const double margin = config::margin_cells * proposal.cell;
  const double before = body.begin - proposal.min[0], after = proposal.max[0] - body.end;
  if (before < margin || after < margin) {
    const bool first = before < margin;
    throw UserError(
        "{}: {}: the section {} {} m {} the release; needed: at least {} m, {} cells. Make the line longer there.",
        line_option, options.line, first ? "begins" : "ends",
        rounded_text(first ? body.begin : profile.distance.back() - body.end, 3), first ? "before" : "after",
        rounded_text(rounded_up(margin + proposal.cell, 3), 3), config::margin_cells + 1);
  }
}

}  // namespace

int make_section(const SectionOptions& options) {
  require_utf8("the folder to make", title_of(options.folder));
  config::Case trial = trial_case(options.folder, options.maps);
  trial.maps.path = options.line;
  trial.locations["maps.path"] = line_option;
  config::Site site = open_site(trial);
  double taper = 0.0;
  if (options.maps.cut && !options.maps.release.empty()) {
    taper = taper_edges(trial, site).width;
    trial.bodies.at(body_name).placement = config::Placement::cut;
    site = reopen_site(trial);
  }
  Cut cut = cut_along_line(site, options.line);
  site = smoothed_site(trial, cell_of(cut.profile, site.roughness->spacing));
  cut = cut_along_line(site, options.line);
  if (site.roughness->width > 0.0) {
    fmt::print("note: {}\n", format_filter(options, *site.roughness));
  }
  const fs::path folder = options.folder;
  const std::vector<std::string> comments = comments_on(options, site, cut, taper);
  if (options.maps.release.empty()) {
    make_new_folder(folder);
    io::write_profile_csv(folder / profile_name, cut.profile, comments);
    fmt::print(
        "{}: {} rows over {} m\n"
        "note: without --release there is no body, and no case.toml was written\n",
        (folder / profile_name).string(), cut.profile.distance.size(), rounded_text(cut.profile.distance.back(), 3));
    return static_cast<int>(ExitCode::done);
  }
  const config::SurfaceBody body = config::body_on(cut.profile);
  if (!(body.area > 0.0)) {
    throw UserError(
        "{}: {}: the line does not cross the release of {}. Draw it through the release, or leave --release out for "
        "the profile alone.",
        line_option, options.line, options.maps.release);
  }
  const config::Proposal proposal = config::propose_section(cut.profile, body);
  check_body(options, cut.profile, body, proposal);
  make_new_folder(folder);
  io::write_profile_csv(folder / profile_name, cut.profile, comments);
  write_file_atomically(folder / "case.toml", config::section_text(title_of(folder), profile_name, proposal));
  const auto base = base_by_block(folder);
  write_file_atomically(folder / "case.toml", config::section_text(title_of(folder), profile_name, proposal, base));
  fmt::print("{}: a release of {} m3 per metre of width, {} m thick, on {} m cells: about {} particles\n",
             (folder / "case.toml").string(), rounded_text(proposal.volume, 3), rounded_text(proposal.thickness, 3),
             proposal.cell, rounded_text(proposal.particles));
  if (base) {
    fmt::print("{}", base_text(*base));
  }
  print_next_commands(options.program, folder);
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app

#else

namespace thawslide::app {

int make_section(const SectionOptions& options) { fail_without_gis(options.maps.dem); }

}  // namespace thawslide::app

#endif
