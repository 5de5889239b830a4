#include "io/run_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "io/atomic_file.hpp"
#include "io/checkpoint.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view files_of_a_run[] = {"run.json",      "history.csv", "probes.csv",
                                               "case.toml",     "terrain.csv", "particles.vtkhdf",
                                               checkpoint_name, "report.html", previous_checkpoint_name,
                                               "snapshots",     "inputs",      "figures",
                                               "maps"};

// What a resume keeps beside a file that it found damaged, by name_for_damaged.
bool is_damaged_one(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.rfind("history.damaged.", 0) == 0 || name.rfind("probes.damaged.", 0) == 0 ||
         name.rfind("checkpoint.damaged.", 0) == 0;
}

bool holds_a_run(const fs::path& folder) {
  return fs::exists(folder / "run.json") || fs::exists(folder / "history.csv") || fs::exists(folder / "snapshots");
}

// A process that ended before it had written run.json has left its lock, and nothing that anyone would miss.
bool holds_no_more_than_a_start(const fs::path& folder) {
  if (!fs::exists(folder / lock_name) || fs::exists(folder / "run.json")) {
    return false;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_known =
        name == lock_name || is_unfinished(entry.path()) ||
        std::find(std::begin(files_of_a_run), std::end(files_of_a_run), name) != std::end(files_of_a_run);
    const bool has_rows = name == "history.csv" && fs::file_size(entry.path()) > 0;
    if (!is_known || has_rows) {
      return false;
    }
  }
  return true;
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
        fmt::format("the output folder {} cannot be made: it is a link to a folder that is not there. Give another "
                    "--output.",
                    folder.string()));
  }
  const fs::path part = existing_part(folder);
  if (!fs::is_directory(part)) {
    throw UserError(fmt::format("the output folder {} cannot be made: {} is a file. Give another --output.",
                                folder.string(), part.string()));
  }
  if (access(part.c_str(), W_OK) != 0) {
    throw UserError(fmt::format("the output folder {} cannot be written: no permission for {}. Give another --output.",
                                folder.string(), part.string()));
  }
  if (fs::exists(folder) && !fs::is_empty(folder) && !holds_no_more_than_a_start(folder)) {
    if (!holds_a_run(folder)) {
      throw UserError(
          fmt::format("the output folder {} holds other files and no run. Give another --output.", folder.string()));
    }
    if (const std::string process = process_at_work(folder).process; !process.empty() && !overwrite) {
      throw UserError(
          fmt::format("the output folder {} is being written by {}. Give another --output.", folder.string(), process));
    }
    if (!overwrite) {
      throw UserError(
          fmt::format("the output folder {} holds another run. Give another --output, or --overwrite to replace "
                      "that run.",
                      folder.string()));
    }
  }
}

void require_own_folders(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::is_symlink(folder / name)) {
      throw UserError(fmt::format(
          "{} is a link; a run writes and reads its files in its own folder alone. Put the folder itself there.",
          (folder / name).string()));
    }
  }
}

RunLock make_run_folder(const fs::path& folder, bool overwrite) {
  require_usable(folder, overwrite);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw WriteError(fmt::format("the output folder {} cannot be made: {}. Give another --output.", folder.string(),
                                 error.message()));
  }
  RunLock lock(folder);
  require_usable(folder, overwrite);
  for (const std::string_view name : files_of_a_run) {
    fs::remove_all(folder / name, error);
    if (error) {
      throw UserError(fmt::format("cannot remove {}: {}", (folder / name).string(), error.message()));
    }
  }
  std::vector<fs::path> damaged;
  std::copy_if(fs::directory_iterator(folder), fs::directory_iterator(), std::back_inserter(damaged), is_damaged_one);
  for (const fs::path& file : damaged) {
    fs::remove(file);
  }
  remove_unfinished_files(folder);
  return lock;
}

}  // namespace thawslide::io
