// Figure of the setup of a case: its description as JSON, and the call of the program that plots it.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "app/setup_facts.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "config/keywords.hpp"
#include "sim/setup/release_body.hpp"

namespace thawslide::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr int largest_picture = 600;  // maximum number of raster points along each axis

// Every n-th point of a raster, at most `largest_picture` along each axis; null for no data.
Json thinned(const Raster& raster) {
  const int every = std::max(1, (std::max(raster.columns, raster.rows) + largest_picture - 1) / largest_picture);
  Json values = Json::array();
  int columns = 0, rows = 0;
  for (int row = 0; row < raster.rows; row += every, ++rows) {
    columns = 0;
    for (int column = 0; column < raster.columns; column += every, ++columns) {
      const double value = raster.at(column, row);
      values.push_back(std::isnan(value) ? Json() : Json(value));
    }
  }
  return {{"x0", raster.x},
          {"y0", raster.y},
          {"cell_x", raster.cell_x * every},
          {"cell_y", raster.cell_y * every},
          {"columns", columns},
          {"rows", rows},
          {"heights", values}};
}

// Names of the substrates, and their numbers at given points, 0 if there is none. Null if the case has none.
template <int Dim>
Json substrates_json(const sim::Simulation<Dim>& simulation, const Json& numbers) {
  if (numbers.is_null()) {
    return {};
  }
  Json names = Json::array();
  for (const auto& [name, substrate] : simulation.parameters().substrates) {
    names.push_back(name);
  }
  return {{"names", names}, {"numbers", numbers}};
}

Json numbers_on_map(const sim::Simulation<3>& simulation) {
  const auto& substrates = simulation.model().substrates;
  if (!substrates) {
    return {};
  }
  Raster numbers = *simulation.site().ground;
  const auto& origin = simulation.model().origin;
  for_each_point(numbers, [&](int column, int row, double& value) {
    value = substrates->at(numbers.x_of(column) - origin[0], numbers.y_of(row) - origin[1]);
  });
  return thinned(numbers);
}

Json map_json(const sim::Simulation<3>& simulation) {
  const config::Case& parameters = simulation.parameters();
  const config::Site& site = simulation.site();
  Json json;
  json["title"] = parameters.general.title.empty() ? parameters.name : parameters.general.title;
  json["crs"] = site.crs_name;
  json["cell"] = parameters.grid.cell;
  json["min"] = {parameters.grid.min[0], parameters.grid.min[1]};
  json["max"] = {parameters.grid.max[0], parameters.grid.max[1]};
  json["terrain"] = thinned(*site.ground);
  json["bodies"] = Json::array();
  for (const auto& [name, body] : parameters.bodies) {
    Json entry = {{"name", name}, {"material", body.material}};
    const auto release = site.releases.find(name);
    if (release != site.releases.end()) {
      entry["outlines"] = release->second.outlines;
      entry["volume_m3"] = volume_of(release->second.thickness);
      entry["thickness"] = thinned(release->second.thickness);
    }
    json["bodies"].push_back(entry);
  }
  json["substrates"] = substrates_json<3>(simulation, numbers_on_map(simulation));
  json["path"] = site.path;
  json["probes"] = site.probes;
  return json;
}

template <int Dim>
std::vector<double> point_in_section(const sim::Simulation<Dim>& simulation, std::size_t p) {
  const auto& origin = simulation.model().origin;
  return {simulation.particles().position(p, 0) + origin[0],
          simulation.particles().position(p, Dim - 1) + origin[Dim - 1]};
}

template <int Dim>
Json section_json(const sim::Simulation<Dim>& simulation) {
  const config::Case& parameters = simulation.parameters();
  const auto& model = simulation.model();
  const auto kinds = config::choices(config::BoundaryKind{});
  Json json;
  json["title"] = parameters.general.title.empty() ? parameters.name : parameters.general.title;
  json["cell"] = parameters.grid.cell;
  json["min"] = {parameters.grid.min[0], parameters.grid.min[Dim - 1]};
  json["max"] = {parameters.grid.max[0], parameters.grid.max[Dim - 1]};
  const char* faces[] = {"x_min", "x_max", "y_min", "y_max"};
  for (std::size_t f = 0; f < 4; ++f) {
    const std::size_t face = f < 2 ? f : 2 * (Dim - 1) + f - 2;
    json["boundary"][faces[f]] =
        std::ranges::find(kinds, parameters.grid.boundary[face], &config::Choice<config::BoundaryKind>::value)->keyword;
  }
  json["terrain"] = nullptr;
  Json numbers;
  if (model.profile) {
    constexpr int samples = 1000;
    Json x = Json::array();
    Json z = Json::array();
    for (int k = 0; k <= samples; ++k) {
      const double station = model.constraints.extent[0] * k / samples;
      x.push_back(station + model.origin[0]);
      z.push_back(model.profile->height(station) + model.origin[Dim - 1]);
      if (model.substrates) {
        numbers.push_back(model.substrates->at(station, 0.0));
      }
    }
    json["terrain"] = {{"x", x}, {"z", z}};
  }
  json["substrates"] = substrates_json<Dim>(simulation, numbers);
  for (std::size_t b = 0; b < parameters.bodies.size(); ++b) {
    const auto& body = parameters.bodies.at(model.body_names[b]);
    Json points = Json::array();
    for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
      if (simulation.particles().body(p) == static_cast<int>(b)) {
        points.push_back(point_in_section(simulation, p));
      }
    }
    json["bodies"].push_back({{"name", model.body_names[b]},
                              {"material", body.material},
                              {"points", points},
                              {"spacing", parameters.grid.cell / body.particles_per_axis}});
  }
  json["frames"] = Json::array();
  for (const auto& [name, frame] : parameters.frames) {
    json["frames"].push_back({{"name", name},
                              {"min", {frame.min[0], frame.min[Dim - 1]}},
                              {"max", {frame.max[0], frame.max[Dim - 1]}},
                              {"axis", frame.axis},
                              {"velocity", frame.velocity}});
  }
  return json;
}

}  // namespace

std::string picture_path(const std::filesystem::path& case_file) {
  const std::string variant = case_file.stem() == "case" ? "" : case_file.stem().string() + "-";
  return (case_file.parent_path() / (variant + "setup.png")).string();
}

void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture) {
  std::string file = std::filesystem::temp_directory_path() / "thawslide-setup-XXXXXX";
  const int descriptor = mkstemp(file.data());
  const bool is_written = descriptor >= 0 && (std::ofstream(file) << setup.dump() << std::flush).good();
  close(descriptor);
  if (!is_written) {
    unlink(file.c_str());
    throw UserError("the picture was not drawn: the temporary file {} cannot be written.", file);
  }
  std::fflush(stdout);  // so that earlier output precedes that of the program, which goes to stderr
  const std::string command =
      fmt::format("{} --setup {} --picture {} >&2", shell_quote(python_program("thawslide-report")), shell_quote(file),
                  shell_quote(picture));
  const int status = std::system(command.c_str());
  unlink(file.c_str());
  if (status != 0) {
    const bool is_found = !WIFEXITED(status) || WEXITSTATUS(status) != 127;
    throw UserError("the picture was not drawn: thawslide-report {}. {}", is_found ? "failed" : "is not on PATH",
                    python_program_remedy);
  }
}

template <int Dim>
nlohmann::ordered_json setup_json(const sim::Simulation<Dim>& simulation) {
  if constexpr (Dim == 3) {
    if (simulation.site().ground != nullptr) {
      return map_json(simulation);
    }
  }
  return section_json<Dim>(simulation);
}

template nlohmann::ordered_json setup_json<2>(const sim::Simulation<2>&);
template nlohmann::ordered_json setup_json<3>(const sim::Simulation<3>&);

}  // namespace thawslide::app
