#include "config/named_files.hpp"

#include <algorithm>

namespace thawslide::config {

std::vector<InputFile> named_files(const Case& parameters) {
  std::vector<InputFile> files;
  const auto add = [&files](const std::filesystem::path& file, bool is_map) {
    const auto is_it = [&file](const InputFile& other) { return other.file == file; };
    if (!file.empty() && std::none_of(files.begin(), files.end(), is_it)) {
      files.push_back({file, is_map});
    }
  };
  for (const CaseFile& each : parameters.case_files) {
    add(each.file, false);
  }
  add(parameters.terrain.file, parameters.terrain.kind == TerrainKind::dem);
  add(parameters.report.logo, false);
  add(parameters.report.targets, false);
  add(parameters.report.force_record, false);
  add(parameters.maps.path, true);
  for (const auto& [name, body] : parameters.bodies) {
    const bool has_raster =
        body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface;
    add(body.release, true);
    add(has_raster ? body.thickness.source : "", true);
    for (const auto& [key, field] : fields_of(body)) {
      add(field->over == InitialField::Over::raster ? field->source : "", true);
    }
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    add(substrate.outline, true);
    add(substrate.raster, true);
  }
  const InitialField& depth = parameters.bed.depth;
  add(parameters.bed.outline, true);
  add(depth.over == InitialField::Over::raster ? depth.source : "", true);
  for (const auto& [name, probe] : parameters.probes) {
    add(probe.line, true);
  }
  return files;
}

}  // namespace thawslide::config
