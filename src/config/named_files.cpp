#include "config/named_files.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

// Calls add(key, file) for the map files of bodies, maps and probes; names may be empty.
template <class Add>
void add_map_files(const Case& parameters, const Add& add) {
  add("maps.path", parameters.maps.path);
  for (const auto& [name, body] : parameters.bodies) {
    const std::string table = "body." + name + ".";
    add(table + "release", body.release);
    if (body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface) {
      add(table + "thickness", body.thickness.source);
    }
    for (const auto& [key, field] : fields_of(body)) {
      if (field->over == InitialField::Over::raster) {
        add(table + key, field->source);
      }
    }
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    const std::string table = "substrate." + name + ".";
    add(table + "outline", substrate.outline);
    add(table + "raster", substrate.raster);
  }
  add("bed.outline", parameters.bed.outline);
  if (parameters.bed.depth.over == InitialField::Over::raster) {
    add("bed.depth", parameters.bed.depth.source);
  }
  for (const auto& [name, probe] : parameters.probes) {
    add("probe." + name + ".line", probe.line);
  }
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
  add_map_files(parameters, [&add](const std::string& key, const std::string& file) { add(key, file, true); });
  return files;
}

}  // namespace thawslide::config
