#include "config/named_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "config/checks.hpp"

namespace thawslide::config {

std::vector<InputFile> named_files(const Case& parameters) {
  std::vector<InputFile> files;
  const auto add = [&files](const std::string& key, const std::filesystem::path& file, bool is_map) {
    const auto is_it = [&file](const InputFile& other) { return other.file == file; };
    if (!file.empty() && std::none_of(files.begin(), files.end(), is_it)) {
      files.push_back({key, file, is_map});
    }
  };
  for (const CaseFile& each : parameters.case_files) {
    add(files.empty() ? "" : "case.based_on", each.file, false);
  }
  add("terrain.file", parameters.terrain.file, parameters.terrain.kind == TerrainKind::dem);
  add("report.logo", parameters.report.logo, false);
  add("report.targets", parameters.report.targets, false);
  add("report.force_record", parameters.report.force_record, false);
  add("maps.path", parameters.maps.path, true);
  for (const auto& [name, body] : parameters.bodies) {
    const std::string table = "body." + name + ".";
    const bool has_raster =
        body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface;
    add(table + "release", body.release, true);
    add(table + "thickness", has_raster ? body.thickness.source : "", true);
    for (const auto& [key, field] : fields_of(body)) {
      add(table + key, field->over == InitialField::Over::raster ? field->source : "", true);
    }
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    add("substrate." + name + ".outline", substrate.outline, true);
    add("substrate." + name + ".raster", substrate.raster, true);
  }
  const InitialField& depth = parameters.bed.depth;
  add("bed.outline", parameters.bed.outline, true);
  add("bed.depth", depth.over == InitialField::Over::raster ? depth.source : "", true);
  for (const auto& [name, probe] : parameters.probes) {
    add("probe." + name + ".line", probe.line, true);
  }
  return files;
}

void check_file_names(const Case& checked, Reading& reading) {
  const std::vector<InputFile> files = named_files(checked);
  for (std::size_t later = 1; later < files.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const auto& [key, file, is_map] = files[later];
      const auto& [other_key, other, other_is_map] = files[earlier];
      if (file.filename() == other.filename() && reading.are_valid({key, other_key})) {
        reading.report_misfit(
            {key, other_key.empty() ? key : other_key},
            fmt::format("{} leads to {}, and {} {}; allowed: names of their own, since a run keeps copies of all its "
                        "inputs in one folder. Rename one.",
                        key, file.string(), other_key.empty() ? "the case file is" : other_key + " to",
                        other.string()));
      }
    }
  }
}

}  // namespace thawslide::config
