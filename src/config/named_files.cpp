#include "config/named_files.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

// Map files of bodies, maps and probes; may contain empty names.
std::vector<InputFile> map_files(const Case& parameters) {
  std::vector<InputFile> files{{"maps.path", parameters.maps.path}};
  for (const auto& [name, body] : parameters.bodies) {
    const std::string table = "body." + name + ".";
    files.push_back({table + "release", body.release});
    if (body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface) {
      files.push_back({table + "thickness", body.thickness.source});
    }
    for (const auto& [key, field] : fields_of(body)) {
      if (field->over == InitialField::Over::raster) {
        files.push_back({table + key, field->source});
      }
    }
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    const std::string table = "substrate." + name + ".";
    files.push_back({table + "outline", substrate.outline});
    files.push_back({table + "raster", substrate.raster});
  }
  files.push_back({"bed.outline", parameters.bed.outline});
  if (parameters.bed.depth.over == InitialField::Over::raster) {
    files.push_back({"bed.depth", parameters.bed.depth.source});
  }
  for (const auto& [name, probe] : parameters.probes) {
    files.push_back({"probe." + name + ".line", probe.line});
  }
  return files;
}

}  // namespace

std::vector<InputFile> named_files(const Case& parameters) {
  std::vector<InputFile> files;
  const auto add = [&files](const std::string& key, const fs::path& file, bool is_map) {
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
  for (const InputFile& map : map_files(parameters)) {
    add(map.key, map.file, true);
  }
  return files;
}

}  // namespace thawslide::config
