#include "app/resolved_case.hpp"

#include <algorithm>

#include "config/describe.hpp"
#include "io/atomic_file.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

// The files beside one that belong to it: the parts of a shapefile, coordinate system and place of a raster.
std::vector<fs::path> companions(const fs::path& file) {
  std::vector<fs::path> result;
  for (const char* ending : {".shx", ".dbf", ".prj", ".cpg", ".tfw"}) {
    std::string upper = ending;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](char c) { return c == '.' ? c : char(c - 'a' + 'A'); });
    for (const std::string& each : {std::string(ending), upper}) {
      result.push_back(fs::path(file).replace_extension(each));
    }
  }
  result.emplace_back(file.string() + ".aux.xml");
  return result;
}

// The files that bodies, maps and probes are read from, and the DEM.
std::vector<fs::path> map_files(const config::Case& parameters) {
  std::vector<std::string> files{parameters.maps.path};
  if (parameters.terrain.kind == config::TerrainKind::dem) {
    files.push_back(parameters.terrain.file);
  }
  for (const auto& [name, body] : parameters.bodies) {
    files.push_back(body.release);
    if (body.thickness.from != config::MapValue::From::attribute) {
      files.push_back(body.thickness.source);
    }
    for (const InitialField* field : {&body.temperature, &body.saturation, &body.porosity, &body.ice_content}) {
      if (field->over == InitialField::Over::raster) {
        files.push_back(field->source);
      }
    }
  }
  for (const auto& [name, probe] : parameters.probes) {
    files.push_back(probe.line);
  }
  files.erase(std::remove(files.begin(), files.end(), ""), files.end());
  return {files.begin(), files.end()};
}

// Every file that the case is read from, each once.
std::vector<fs::path> input_files(const config::Case& parameters) {
  std::vector<fs::path> files(parameters.case_files.begin(), parameters.case_files.end());
  const auto add = [&](const fs::path& file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) {
      files.push_back(file);
    }
  };
  add(parameters.terrain.file);
  add(parameters.report.targets);
  for (const fs::path& file : map_files(parameters)) {
    add(file);
    for (const fs::path& companion : companions(file)) {
      if (fs::is_regular_file(companion)) {
        add(companion);
      }
    }
  }
  return files;
}

}  // namespace

std::vector<io::InputFile> write_resolved_case(const config::Case& parameters, const fs::path& folder) {
  std::vector<io::InputFile> inputs = io::copy_inputs(folder, input_files(parameters));
  io::write_file_atomically(folder / "case.toml", config::resolved_toml(parameters, "inputs"));
  return inputs;
}

}  // namespace thawslide::app
