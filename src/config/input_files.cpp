#include "config/input_files.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

std::string in_capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return text;
}

// The files beside a map that belong to it, of those that there are.
std::vector<fs::path> companions(const fs::path& map) {
  std::vector<fs::path> result{map.string() + ".aux.xml"};
  for (const std::string ending : {".shx", ".dbf", ".prj", ".cpg", ".tfw"}) {
    result.push_back(fs::path(map).replace_extension(ending));
    result.push_back(fs::path(map).replace_extension(in_capitals(ending)));
  }
  result.erase(
      std::remove_if(result.begin(), result.end(), [](const fs::path& file) { return !fs::is_regular_file(file); }),
      result.end());
  return result;
}

// The DEM, and what bodies, maps and probes are read from; may hold empty names.
std::vector<std::string> map_files(const Case& parameters) {
  std::vector<std::string> files{parameters.maps.path};
  if (parameters.terrain.kind == TerrainKind::dem) {
    files.push_back(parameters.terrain.file);
  }
  for (const auto& [name, body] : parameters.bodies) {
    files.push_back(body.release);
    if (body.thickness.from == MapValue::From::raster || body.thickness.from == MapValue::From::surface) {
      files.push_back(body.thickness.source);
    }
    for (const InitialField* field : {&body.temperature, &body.saturation, &body.porosity, &body.ice_content}) {
      if (field->over == InitialField::Over::raster) {
        files.push_back(field->source);
      }
    }
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    files.insert(files.end(), {substrate.outline, substrate.raster});
  }
  if (parameters.bed.depth.over == InitialField::Over::raster) {
    files.push_back(parameters.bed.depth.source);
  }
  for (const auto& [name, probe] : parameters.probes) {
    files.push_back(probe.line);
  }
  return files;
}

}  // namespace

std::vector<fs::path> input_files(const Case& parameters) {
  std::vector<fs::path> files;
  const auto add = [&files](const fs::path& file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) {
      files.push_back(file);
    }
  };
  for (const std::string& file : parameters.case_files) {
    add(file);
  }
  add(parameters.terrain.file);
  add(parameters.report.targets);
  for (const std::string& file : map_files(parameters)) {
    add(file);
    if (!file.empty()) {
      for (const fs::path& companion : companions(file)) {
        add(companion);
      }
    }
  }
  return files;
}

}  // namespace thawslide::config
