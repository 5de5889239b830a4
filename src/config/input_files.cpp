#include "config/input_files.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

std::string in_capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return text;
}

// Existing companion files of a map.
std::vector<fs::path> companions(const fs::path& map) {
  std::vector<fs::path> result{map.string() + ".aux.xml", map.string() + ".msk"};
  for (const std::string ending : {".shx", ".dbf", ".prj", ".cpg", ".tfw"}) {
    result.push_back(fs::path(map).replace_extension(ending));
    result.push_back(fs::path(map).replace_extension(in_capitals(ending)));
  }
  result.erase(
      std::remove_if(result.begin(), result.end(), [](const fs::path& file) { return !fs::is_regular_file(file); }),
      result.end());
  return result;
}

// DEM, and map files of bodies, maps and probes; may contain empty names.
std::vector<InputFile> map_files(const Case& parameters) {
  std::vector<InputFile> files{{"maps.path", parameters.maps.path}};
  if (parameters.terrain.kind == TerrainKind::dem) {
    files.push_back({"terrain.file", parameters.terrain.file});
  }
  for (const auto& [name, body] : parameters.bodies) {
    const std::string table = "body." + name + ".";
    files.push_back({table + "release", body.release});
    if (body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface) {
      files.push_back({table + "thickness", body.thickness.source});
    }
    for (const auto& [key, field] :
         {std::pair("temperature", &body.temperature), std::pair("saturation", &body.saturation),
          std::pair("porosity", &body.porosity), std::pair("ice_content", &body.ice_content)}) {
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
  if (parameters.bed.depth.over == InitialField::Over::raster) {
    files.push_back({"bed.depth", parameters.bed.depth.source});
  }
  for (const auto& [name, probe] : parameters.probes) {
    files.push_back({"probe." + name + ".line", probe.line});
  }
  return files;
}

}  // namespace

std::vector<InputFile> input_files_by_key(const Case& parameters) {
  std::vector<InputFile> files;
  const auto add = [&files](const std::string& key, const fs::path& file) {
    const auto is_it = [&file](const InputFile& other) { return other.file == file; };
    if (!file.empty() && std::none_of(files.begin(), files.end(), is_it)) {
      files.push_back({key, file});
    }
  };
  for (const CaseFile& each : parameters.case_files) {
    add(files.empty() ? "" : "case.based_on", each.file);
  }
  add("terrain.file", parameters.terrain.file);
  add("report.targets", parameters.report.targets);
  add("report.force_record", parameters.report.force_record);
  for (const InputFile& map : map_files(parameters)) {
    add(map.key, map.file);
    if (!map.file.empty()) {
      for (const fs::path& companion : companions(map.file)) {
        add(map.key, companion);
      }
    }
  }
  return files;
}

std::vector<fs::path> input_files(const Case& parameters) {
  std::vector<fs::path> files;
  for (InputFile& input : input_files_by_key(parameters)) {
    files.push_back(std::move(input.file));
  }
  return files;
}

}  // namespace thawslide::config
