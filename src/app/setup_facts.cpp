#include "app/setup_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kg_per_tonne = 1e3;
constexpr double kilobyte = 1e3, megabyte = 1e6, gigabyte = 1e9;

std::string size_text(double bytes) {
  return bytes < megabyte   ? rounded_text(bytes / kilobyte) + " kB"
         : bytes < gigabyte ? rounded_text(bytes / megabyte) + " MB"
                            : rounded_text(bytes / gigabyte) + " GB";
}

std::string text_of(const sim::BodyFigures& body, const SetupFacts& facts) {
  const bool is_plane = facts.dimension == 2;
  const std::string per_metre = facts.width_varies_from
                                    ? fmt::format(" per metre of the width at x = {:.9g} m", *facts.width_varies_from)
                                    : " per metre of width";
  return fmt::format(
      "  body        {}: {} m3 and {} t{}, {} {} {}; {} m thick on average, {} m in the median and {} m at most "
      "(vertical)\n"
      "              {} particles {} m apart; {:.3g} across in the median and {:.3g} at most; {}\n",
      body.name, rounded_text(body.volume, 3), rounded_text(body.mass / kg_per_tonne, 3), is_plane ? per_metre : "",
      is_plane ? "along" : "over", rounded_text(body.area, 3), is_plane ? "m" : "m2",
      rounded_text(body.mean_thickness, 3), rounded_text(body.median_thickness, 3),
      rounded_text(body.largest_thickness, 3), count_text(static_cast<double>(body.particles)),
      rounded_text(body.spacing, 3), body.particles_across, body.max_particles_across,
      body.coldest == body.warmest ? fmt::format("{:.3g} C", body.coldest)
                                   : fmt::format("{:.3g} to {:.3g} C", body.coldest, body.warmest));
}

// Bodies in the order of their release; empty if all are released at the start.
std::string stages_text(std::vector<sim::BodyFigures> bodies) {
  std::ranges::stable_sort(bodies, [](const auto& a, const auto& b) { return a.release_time < b.release_time; });
  if (bodies.empty() || !(bodies.back().release_time > 0.0)) {
    return "";
  }
  std::string text;
  for (const sim::BodyFigures& body : bodies) {
    text += fmt::format("{}{} at {:g} s", text.empty() ? "" : ", ", body.name, body.release_time);
  }
  return fmt::format("  stages      release of {}; held until then\n", text);
}

std::string text_of(const SubstrateFacts& substrate, int dimension) {
  if (substrate.name.empty()) {
    return fmt::format("              {}, {:.3g} % of the domain; {}\n", substrate.location, 100.0 * substrate.fraction,
                       substrate.strength);
  }
  return fmt::format("  substrate   {}: {}, {} {} or {:.3g} % of the domain; {}\n", substrate.name, substrate.location,
                     rounded_text(substrate.covered, 3), dimension == 3 ? "m2" : "m", 100.0 * substrate.fraction,
                     substrate.strength);
}

std::string text_of(const config::Roughness& ground) {
  const std::string filter = ground.width > 0.0
                                 ? fmt::format("smoothed with a standard deviation of {:g} m", ground.width)
                                 : std::string("not smoothed");
  const std::string valleys = ground.width > 0.0
                                  ? fmt::format(
                                        "              In V valleys of 90 degrees filled less than {:g} m wide the "
                                        "filter removes more than 3 % of the friction of their sides\n",
                                        ground.narrow_valley)
                                  : "";
  return fmt::format(
      "  roughness   noise of {:.2g} m rms or {:.2g} cells on points {:g} m apart; bumps shorter than {} m have an rms "
      "slope of {:.2g}\n              {}; remaining friction by noise and bumps about {:.2g} %\n{}",
      ground.noise, ground.noise / ground.cell, ground.spacing, rounded_text(ground.bump_length, 2), ground.bump_slope,
      filter, 100.0 * ground.apparent_friction, valleys);
}

std::string text_of(const run::DiskNeed& need, double free) {
  return fmt::format(
      "  disk        about {}: {} snapshots of {}, {:.0f} checkpoints of {}, history {}, inputs {}{}; {} are free\n",
      size_text(need.total()), count_text(need.snapshots), size_text(need.snapshot), need.checkpoints,
      size_text(need.checkpoint), size_text(need.history), size_text(need.inputs),
      need.maps > 0.0 ? fmt::format(", maps {} before they are compressed", size_text(need.maps)) : "",
      std::isfinite(free) ? size_text(free) : "unknown amounts");
}

Json json_of(const sim::BodyFigures& body) {
  return {{"name", body.name},
          {"particles", body.particles},
          {"volume_m3", body.volume},
          {"mass_kg", body.mass},
          {"area_m2", body.area},
          {"mean_thickness_m", body.mean_thickness},
          {"median_thickness_m", body.median_thickness},
          {"max_thickness_m", body.largest_thickness},
          {"spacing_m", body.spacing},
          {"particles_across", body.particles_across},
          {"max_particles_across", body.max_particles_across},
          {"release_time_s", body.release_time},
          {"coldest_C", body.coldest},
          {"warmest_C", body.warmest},
          {"clearance_m", std::isfinite(body.clearance) ? Json(body.clearance) : Json()},
          {"resting_fraction", body.resting_fraction}};
}

Json json_of(const SubstrateFacts& substrate) {
  return {{"name", substrate.name},
          {"location", substrate.location},
          {"covered", substrate.covered},
          {"fraction", substrate.fraction},
          {"strength", substrate.strength}};
}

Json json_of(const sim::MemoryNeed& need, const AvailableMemory& available) {
  return {{"need_bytes", need.total()},
          {"particles_bytes", need.particles},
          {"output_bytes", need.output},
          {"columns_bytes", need.columns},
          {"bed_bytes", need.bed},
          {"maps_bytes", need.maps},
          {"ground_bytes", need.ground},
          {"available_bytes", available.bytes},
          {"available_reason", available.bound}};
}

Json json_of(const run::DiskNeed& need, double free, const std::string& folder) {
  return {{"need_bytes", need.total()},
          {"snapshots", need.snapshots},
          {"snapshot_bytes", need.snapshot},
          {"checkpoints", need.checkpoints},
          {"checkpoint_bytes", need.checkpoint},
          {"history_rows", need.history_rows},
          {"history_bytes", need.history},
          {"maps_bytes", need.maps},
          {"inputs_bytes", need.inputs},
          {"free_bytes", std::isfinite(free) ? Json(free) : Json()},
          {"folder", folder}};
}

std::string text_of(const run::GpuFacts& gpu) {
  if (!gpu.unavailable_reason.empty()) {
    return fmt::format("  GPU         not used: {}\n", gpu.unavailable_reason);
  }
  return fmt::format("  GPU         about {} (measured on the first steps) and {} of {} free, on {}\n",
                     duration_text(gpu.seconds), size_text(gpu.used), size_text(gpu.free), gpu.name);
}

Json json_of(const run::GpuFacts& gpu) {
  const bool is_available = gpu.unavailable_reason.empty();
  return {{"name", gpu.name.empty() ? Json() : Json(gpu.name)},
          {"unavailable_reason", is_available ? Json() : Json(gpu.unavailable_reason)},
          {"wall_s", is_available ? Json(gpu.seconds) : Json()},
          {"need_bytes", is_available ? Json(gpu.used) : Json()},
          {"free_bytes", gpu.name.empty() ? Json() : Json(gpu.free)}};
}

Json json_of(const MapFacts& maps) {
  return {{"columns", maps.columns},        {"rows", maps.rows},     {"cell_x_m", maps.cell_x},
          {"cell_y_m", maps.cell_y},        {"reason", maps.reason}, {"start_bytes", maps.bytes_at_start},
          {"max_bytes", maps.bytes_at_most}};
}

template <class Facts>
Json list_of(const std::vector<Facts>& all) {
  Json list = Json::array();
  for (const Facts& one : all) {
    list.push_back(json_of(one));
  }
  return list;
}

// Length along x within the domain [m].
double length_of(const config::Substrate& strip, const config::Grid& grid) {
  return std::min(strip.x_max, grid.max[0]) - std::max(strip.x_min, grid.min[0]);
}

// Part of the domain covered by a substrate, along x or as horizontal area.
double covered_by(const std::string& name, const config::Case& parameters, const config::Site& site) {
  const config::Substrate& substrate = parameters.substrates.at(name);
  const double width = parameters.general.dimension == 3 ? parameters.grid.max[1] - parameters.grid.min[1] : 1.0;
  return substrate.is_strip() ? length_of(substrate, parameters.grid) * width : site.substrates.at(name).area;
}

std::string location_of(const config::Substrate& substrate) {
  if (!substrate.raster.empty()) {
    return fmt::format("code {} of its raster", substrate.code);
  }
  if (!substrate.outline.empty()) {
    return "within its polygons";
  }
  if (std::isinf(substrate.x_max)) {
    return fmt::format("from x = {:.9g} m on", substrate.x_min);
  }
  return std::isinf(substrate.x_min) ? fmt::format("up to x = {:.9g} m", substrate.x_max)
                                     : fmt::format("from x = {:.9g} to {:.9g} m", substrate.x_min, substrate.x_max);
}

std::string strength_of(const config::GroundStrength& ground) {
  const double cohesion = ground.numbers(physics::basal::initial_cohesion);
  return fmt::format(
      "friction \"{}\", {}", ground.friction,
      cohesion > 0.0
          ? fmt::format("cohesion {} Pa, \"{}\"",
                        cohesion < 1e3 ? fmt::format("{:g}", cohesion) : with_commas(cohesion, 6), ground.cohesion_law)
          : "no cohesion");
}

}  // namespace

std::string text_of(const SetupFacts& facts) {
  std::string text = fmt::format("{}: {}\n", facts.file,
                                 facts.error.empty() ? "the case is valid" : "the run fails in its first steps");
  for (const sim::BodyFigures& body : facts.bodies) {
    text += text_of(body, facts);
  }
  text += stages_text(facts.bodies);
  for (const SubstrateFacts& substrate : facts.substrates) {
    text += text_of(substrate, facts.dimension);
  }
  if (facts.bed_volume) {
    text += fmt::format("  bed         {} m3 can be entrained{}\n", rounded_text(*facts.bed_volume, 3),
                        facts.dimension == 2 ? " per metre of width" : "");
  }
  if (facts.roughness) {
    text += text_of(*facts.roughness);
  }
  text += fmt::format("  particles   {}\n", count_text(static_cast<double>(facts.particles)));
  text += fmt::format("  cells       {} in the domain; allocated blocks of {} nodes: {}\n", count_text(facts.cells),
                      facts.nodes_of_block, count_text(static_cast<double>(facts.blocks)));
  if (facts.resolution != nullptr) {
    text += fmt::format("              {:.2g} across the thinnest body; {}\n", facts.cells_across,
                        facts.resolution->errors);
  }
  text += fmt::format("  step        {:.3g} s{}; {}\n", facts.step, facts.is_adaptive ? " at the start (adaptive)" : "",
                      std::isfinite(facts.limit.step) ? fmt::format("the limit is {:.3g} s, set by {}",
                                                                    rounded_down(facts.limit.step, 3), facts.limit.what)
                                                      : "no limit applies");
  text += fmt::format("  steps       {}\n",
                      facts.is_adaptive ? "about " + rounded_text(facts.steps) : count_text(facts.steps));
  text += fmt::format("  memory      about {}; {} {}\n", size_text(facts.memory.total()),
                      size_text(facts.available.bytes), facts.available.bound);
  for (const MapFacts& maps : facts.maps) {
    text += fmt::format("  maps        {} x {} cells of {:g} x {:g} m ({}); memory {} for the release, at most {}\n",
                        maps.columns, maps.rows, maps.cell_x, maps.cell_y, maps.reason, size_text(maps.bytes_at_start),
                        size_text(maps.bytes_at_most));
  }
  text += text_of(facts.disk, facts.free_disk);
  if (facts.error.empty()) {
    text += fmt::format("  time        about {}\n", run::text_of(facts.cost));
    text += text_of(facts.gpu);
  }
  if (!facts.picture.empty()) {
    text += fmt::format("  picture     {}\n", facts.picture);
  }
  return text;
}

std::string json_of(const SetupFacts& facts) {
  Json json;
  json["file"] = facts.file;
  json["dimension"] = facts.dimension;
  json["warnings"] = facts.warnings;
  json["bodies"] = list_of(facts.bodies);
  json["substrates"] = list_of(facts.substrates);
  json["bed_volume_m3"] = facts.bed_volume ? Json(*facts.bed_volume) : Json();
  json["roughness"] = Json();
  for (const auto& [name, value] : facts.roughness ? config::named(*facts.roughness) : config::NamedFigures{}) {
    json["roughness"][name] = value;
  }
  json["particles"] = facts.particles;
  json["cells"] = facts.cells;
  json["cells_across"] = facts.cells_across > 0.0 ? Json(facts.cells_across) : Json();
  json["blocks"] = facts.blocks;
  json["nodes_of_block"] = facts.nodes_of_block;
  json["step_s"] = facts.step;
  json["is_adaptive"] = facts.is_adaptive;
  json["step_limit_s"] = facts.limit.step;
  json["step_limit_set_by"] = facts.limit.what;
  json["steps"] = facts.steps;
  json["memory"] = json_of(facts.memory, facts.available);
  json["maps"] = facts.maps.empty() ? Json() : json_of(facts.maps.front());
  json["disk"] = json_of(facts.disk, facts.free_disk, facts.disk_folder);
  json["processor_s"] = std::isfinite(facts.cost.processor) ? Json(facts.cost.processor) : Json();
  json["slowdown"] = facts.cost.slowdown;
  json["threads"] = facts.threads;
  json["gpu"] = facts.error.empty() ? json_of(facts.gpu) : Json();
  json["picture"] = facts.picture.empty() ? Json() : Json(facts.picture);
  json["error"] = facts.error.empty() ? Json() : Json(facts.error);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<SubstrateFacts> substrate_facts(const config::Case& parameters, const config::Site& site) {
  std::vector<SubstrateFacts> facts;
  if (parameters.substrates.empty()) {
    return facts;
  }
  double whole = 1.0, left = 1.0;
  for (std::size_t a = 0; a + 1 < static_cast<std::size_t>(parameters.general.dimension); ++a) {
    whole *= parameters.grid.max[a] - parameters.grid.min[a];
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    const double covered = covered_by(name, parameters, site);
    facts.push_back({name, location_of(substrate), covered, covered / whole, strength_of(substrate)});
    left -= covered / whole;
  }
  const double fraction = std::max(0.0, left);
  facts.push_back({"", "elsewhere [basal]", fraction * whole, fraction, strength_of(parameters.basal)});
  return facts;
}

}  // namespace thawslide::app
