#include "io/run_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "io/files.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;
using IsOwn = std::function<bool(const fs::path& file)>;

// Except run.json.
constexpr std::string_view files_of_a_run =
    "history.csv probes.csv case.toml terrain.csv particles.vtkhdf checkpoint.bin checkpoint.previous.bin report.html "
    "comparison.html summary.html summary.pdf assets.csv terrain-after.tif";
// In maps/, as GeoTIFF with a style (sim/maps/map_kinds.cpp, run/map_output.cpp).
constexpr std::string_view maps_of_a_run =
    "terrain release ground max_thickness final_thickness max_speed max_momentum_flux max_pressure max_pressure_time "
    "arrival_time elevation_change max_basal_temperature max_melt max_pore_pressure";
// In figures/, as images or videos (python/thawslide/figures/__init__.py).
constexpr std::string_view figures_of_a_run =
    "extent_maps view animation slide_speed slide_thickness slide_temperature base_temperature base_pressure "
    "cross_sections impact_maps probes motion velocity plastic_strain temperature pore_pressure force force_record "
    "band base_along energy water entrainment";

// `names`: separated by blanks, which no name has.
bool is_among(const std::string& name, std::string_view names) {
  return !name.empty() && name.find(' ') == std::string::npos &&
         fmt::format(" {} ", names).find(fmt::format(" {} ", name)) != std::string::npos;
}

// Files that a resume kept because of damage (name_for_damaged): history.damaged.csv, history.damaged.2.csv.
bool is_damaged_one(const fs::path& file) {
  const fs::path number = file.stem().extension();  // or ".damaged" itself
  const fs::path stem = number == ".damaged" ? file.stem() : file.stem().stem();
  const bool is_number = number.string().find_first_not_of("0123456789", 1) == std::string::npos;
  const std::string name = stem.stem().string() + file.extension().string();
  return stem.extension() == ".damaged" && (number == ".damaged" || is_number) &&
         (name == "history.csv" || name == "probes.csv" || name == "checkpoint.bin");
}

// Polygons of a map (python/thawslide/contours.py): contours-max_thickness.gpkg.
bool is_contours(const fs::path& file) {
  const std::string name = file.stem().string(), prefix = "contours-";
  return file.extension() == ".gpkg" && name.rfind(prefix, 0) == 0 &&
         is_among(name.substr(prefix.size()), maps_of_a_run);
}

bool is_in_run(const fs::path& file) {
  return is_among(file.filename().string(), files_of_a_run) || is_damaged_one(file) || is_contours(file);
}

bool is_snapshot(const fs::path& file) {
  const std::string number = file.stem().string();
  return file.extension() == ".vtkhdf" && number.size() >= 6 &&
         number.find_first_not_of("0123456789") == std::string::npos;
}

// Includes statistics that a GIS stored for a map, because they do not apply to the next run.
bool is_map(const fs::path& file) {
  const std::string name = file.filename().string(), kind = name.substr(0, name.find('.'));
  const std::string ending = name.substr(kind.size());
  return name == "results.gpkg" ||
         (is_among(kind, maps_of_a_run) &&
          (ending == ".tif" || ending == ".qml" || ending == ".hazard.qml" || ending == ".tif.aux.xml"));
}

bool is_figure(const fs::path& file) {
  return is_among(file.stem().string(), figures_of_a_run) && (file.extension() == ".png" || file.extension() == ".mp4");
}

// Contents of run.json; discarded if it is not JSON.
Json run_json(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  return fs::exists(file) ? Json::parse(read_file(file), nullptr, false) : Json(Json::value_t::discarded);
}

// Names of the copies in inputs/.
std::set<std::string> inputs_of(const Json& facts) {
  std::set<std::string> names;
  if (!facts.is_object() || !facts.contains("inputs") || !facts["inputs"].is_array()) {
    return names;
  }
  for (const Json& input : facts["inputs"]) {
    if (input.is_object() && input.contains("copy") && input["copy"].is_string()) {
      const fs::path copy = input["copy"].get<std::string>();
      if (copy.parent_path() == "inputs") {
        names.insert(copy.filename().string());
      }
    }
  }
  return names;
}

// Folders of a run, and which files in them belong to it.
std::vector<std::pair<std::string, IsOwn>> folders_of(const fs::path& run) {
  const auto is_input = [inputs = inputs_of(run_json(run))](const fs::path& file) {
    return inputs.count(file.filename().string()) > 0;
  };
  return {{"snapshots", is_snapshot}, {"inputs", is_input}, {"maps", is_map}, {"figures", is_figure}};
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    entries.push_back(entry.path());
  }
  return entries;
}

bool is_real_folder(const fs::path& path) { return fs::is_directory(fs::symlink_status(path)); }

void remove_own_of(const fs::path& folder, const IsOwn& is_own) {
  for (const fs::path& file : entries_of(folder)) {
    if (!is_real_folder(file) && (is_own(file) || is_unfinished(file))) {
      remove_or_throw(file);
    }
  }
}

// True if there is a run.json written by this program. Throws UserError if it cannot be read.
bool is_run_folder(const fs::path& folder) {
  const Json facts = run_json(folder);
  return facts.is_object() && facts.contains("program") && facts["program"] == "thawslide";
}

// True if a process that ended before writing run.json has left its lock and no results.
bool contains_only_a_start(const fs::path& folder) {
  if (!fs::exists(folder / lock_name) || fs::exists(folder / "run.json")) {
    return false;
  }
  const std::vector<fs::path> entries = entries_of(folder);
  return std::ranges::all_of(entries, [](const fs::path& entry) {
    const std::string name = entry.filename().string();
    if (name == "snapshots" || name == "inputs") {
      const std::vector<fs::path> within = is_real_folder(entry) ? entries_of(entry) : std::vector{entry};
      return name == "inputs" || std::ranges::all_of(within, is_unfinished);
    }
    return name == lock_name || name == "case.toml" || is_unfinished(entry) ||
           (name == "history.csv" && fs::is_regular_file(entry) && fs::file_size(entry) == 0);
  });
}

// Throws UserError if the folder contains anything that must not be replaced.
void require_replaceable(const fs::path& folder, bool overwrite) {
  if (!is_run_folder(folder)) {
    throw UserError(
        fs::exists(folder / "run.json")
            ? fmt::format("cannot determine whether {} is the folder of a run: its run.json is damaged, or was written "
                          "by another program. Specify another --output, or delete the folder.",
                          folder.string())
            : fmt::format("the output folder {} contains other files, and no run. Specify another --output.",
                          folder.string()));
  }
  if (overwrite) {
    return;
  }
  if (const std::string process = process_at_work(folder); !process.empty()) {
    throw UserError("the output folder {} is being written by {}. Specify another --output.", folder.string(), process);
  }
  throw UserError(
      "the output folder {} contains another run. Specify another --output, or replace that run with --overwrite.",
      folder.string());
}

// Removes the files of a run by their names, links instead of their targets, and folders if they are then empty; last
// run.json, which lists the copies in inputs/ and identifies the folder as that of a run. Throws WriteError.
void remove_files_of_run(const fs::path& folder) {
  for (const auto& [name, is_own] : folders_of(folder)) {
    const fs::path path = folder / name;
    if (is_real_folder(path)) {
      remove_own_of(path, is_own);
    }
    if (fs::is_symlink(path) || (is_real_folder(path) && fs::is_empty(path))) {
      remove_or_throw(path);
    }
  }
  remove_own_of(folder, is_in_run);
  remove_or_throw(folder / "run.json");
}

}  // namespace

fs::path existing_part(const fs::path& folder) {
  fs::path part = fs::absolute(folder);
  while (!fs::exists(part) && part.has_relative_path()) {
    part = part.parent_path();
  }
  return part;
}

void require_usable(const fs::path& folder, bool overwrite) {
  if (fs::is_symlink(folder) && !fs::exists(folder)) {
    throw UserError(
        "the output folder {} cannot be made: it is a link to a folder that is not there. Give another --output.",
        folder.string());
  }
  const fs::path part = existing_part(folder);
  if (!fs::is_directory(part)) {
    throw UserError("the output folder {} cannot be made: {} is a file. Give another --output.", folder.string(),
                    part.string());
  }
  if (access(part.c_str(), W_OK) != 0) {
    throw UserError("the output folder {} cannot be written: no permission for {}. Give another --output.",
                    folder.string(), part.string());
  }
  if (fs::exists(folder) && !fs::is_empty(folder) && !contains_only_a_start(folder)) {
    require_replaceable(folder, overwrite);
  }
}

void require_own_folders(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::is_symlink(folder / name)) {
      throw UserError(
          "{} is a link; a run writes and reads its files in its own folder alone. Put the folder itself there.",
          (folder / name).string());
    }
  }
}

RunLock make_run_folder(const fs::path& folder, bool overwrite) {
  require_usable(folder, overwrite);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw WriteError("the output folder {} cannot be made: {}. Give another --output.", folder.string(),
                     error.message());
  }
  RunLock lock(folder);
  require_usable(folder, overwrite);
  remove_files_of_run(folder);
  return lock;
}

}  // namespace thawslide::io
