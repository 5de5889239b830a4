#include "config/read_case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/error.hpp"
#include "config/case_layers.hpp"
#include "config/checks.hpp"
#include "config/declaration.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {

namespace {

namespace fs = std::filesystem;

// Case file for a file or a folder; throws if there is none.
fs::path find_case_file(const fs::path& given) {
  std::error_code error;
  if (fs::is_regular_file(given, error)) {
    return given;
  }
  const fs::path file = fs::is_directory(given, error) ? given / "case.toml" : given;
  if (const std::string found = other_kind_of_file(file); !found.empty()) {
    throw UserError("{} is {}. Give a case file, or a folder with a case.toml.", file.string(), found);
  }
  if (!fs::is_directory(given, error)) {
    const fs::path normal = given.has_filename() ? given : given.parent_path();
    throw UserError("{}: there is no such file or folder{} Give a case file, or a folder with a case.toml.",
                    given.string(), did_you_mean(normal.filename().string(), names_in(normal.parent_path(), ""), "."));
  }
  if (!fs::is_regular_file(file, error)) {
    const std::vector<std::string> others = names_in(given, ".toml");
    throw UserError("{}: the folder has no case.toml. {}", given.string(),
                    others.empty() ? "Give a case file, or a folder with a case.toml."
                                   : fmt::format("Give one of its case files: {}.", comma_list(others)));
  }
  return file;
}

// Reports top-level names in the file that are not known tables.
void report_unknown_tables(const toml::table& root, Reading& reading) {
  std::set<std::string> top;
  std::vector<std::string> titles;
  for (const auto& table : tables()) {
    top.insert(table->name.substr(0, table->name.find('.')));
    titles.push_back(table->title());
  }
  for (const auto& [key, node] : root) {
    const std::string word(key.str());
    if (top.count(word) > 0) {
      continue;
    }
    const std::vector<std::string> homes = node.is_table() ? std::vector<std::string>{} : tables_with(word);
    const std::vector<std::string> known(top.begin(), top.end());
    const std::string hint =
        homes.empty() ? did_you_mean(word, known, ".") : fmt::format("; it belongs in {}.", fmt::join(homes, " or "));
    reading.report_at(reading.location_of(word, key.source()), word, "{} is not known{} Allowed: {}.",
                      node.is_table() ? "table [" + word + "]" : "key '" + word + "' outside of a table", hint,
                      comma_list(titles));
  }
}

std::string name_of(const fs::path& absolute_file) {
  const std::string folder = absolute_file.parent_path().filename().string();
  const std::string stem = absolute_file.stem().string();
  return absolute_file.filename() == "case.toml" ? folder : folder + "-" + stem;
}

void read_tables(const toml::table& root, Case& result, Reading& reading) {
  if (root.at_path("case.dimension").value<std::int64_t>() == 3) {  // keys of [case] depend on it
    reading.dimension = 3;
  }
  for (const auto& table : tables()) {
    table->read(root, result, reading);
    if (table->name == "case") {
      reading.dimension = reading.are_valid({"case.dimension"}) ? result.general.dimension : 0;
    }
  }
  report_unknown_tables(root, reading);
  for (const auto& table : tables()) {
    table->complete(result, reading);
  }
}

// Moves grid.max to whole cells: outwards, or inwards where the ground is known only inside the domain (a DEM, a
// profile that does not continue). On these, cells begin at the terrain, and any height of the domain fits.
void fit_domain_to_cells(Case& parameters, Reading& reading) {
  Grid& grid = parameters.grid;
  const auto dimension = static_cast<std::size_t>(reading.dimension);
  if (!reading.are_valid({"grid.cell", "grid.min", "grid.max", "terrain.type", "terrain.extend"})) {
    return;
  }
  const bool is_bounded = has_terrain(parameters) && !parameters.terrain.extend;
  Point corner = grid.max;
  for (std::size_t a = 0; a < dimension - (has_terrain(parameters) ? 1 : 0); ++a) {
    const double cells = (grid.max[a] - grid.min[a]) / grid.cell;
    if (cells >= 1.0 && std::abs(cells - std::round(cells)) > 1e-6 * cells) {
      corner[a] = grid.min[a] + grid.cell * (is_bounded ? std::floor(cells) : std::ceil(cells));
    }
  }
  if (corner != grid.max) {
    const auto text = [&](const Point& point) {
      return Value<Point>::write(point, {}, {.dimension = reading.dimension, .input_folder = {}});
    };
    reading.notes.push_back(fmt::format("note: {}: grid.max is {} for whole cells of {} m, in place of {}",
                                        reading.location_of("grid.cell").text(), text(corner), plain_number(grid.cell),
                                        text(grid.max)));
    grid.max = corner;
  }
}

}  // namespace

std::vector<CaseFile> read_case_files(const fs::path& case_file_or_folder) {
  return read_with_bases(find_case_file(case_file_or_folder));
}

Case read_case(const fs::path& case_file_or_folder, const std::vector<std::string>& sets) {
  std::error_code error;
  std::vector<Override> overrides;
  for (const std::string& set : sets) {
    overrides.push_back(parse_override(set));
    overrides.back().folder = fs::current_path(error);
  }
  return case_of(read_case_files(case_file_or_folder), overrides);
}

Case case_of(const std::vector<CaseFile>& files, const std::vector<Override>& overrides) {
  Reading reading;
  reading.overrides = overrides;
  reading.file = files.front().file.string();
  const fs::path absolute = fs::absolute(files.front().file).lexically_normal();
  reading.folder = absolute.parent_path();

  Case result;
  result.name = name_of(absolute);
  result.file = absolute.string();
  LayeredCase layered = merged(files);
  apply_overrides(layered.root, reading);
  read_tables(layered.root, result, reading);
  for (const auto& [key, location] : reading.locations) {
    result.locations[key] = location.text();
    const auto marked = layered.lines_not_given.find(location.source);
    if (marked != layered.lines_not_given.end() && marked->second.count(location.line) > 0) {
      result.not_given.insert(key);
    }
  }
  if (reading.dimension != 0) {
    fit_domain_to_cells(result, reading);
  }
  result.notes = reading.notes;
  // The merged case is complete and no longer depends on its base.
  result.general.based_on.clear();
  for (const CaseFile& each : files) {
    result.case_files.push_back({fs::absolute(each.file).lexically_normal(), each.text});
  }
  check_case(result, reading);
  reading.problems.raise_if_any();
  return result;
}

}  // namespace thawslide::config
