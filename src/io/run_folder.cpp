#include "io/run_folder.hpp"

#include <unistd.h>

#include "base/error.hpp"
#include "io/run_files.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

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
  const AtWork at_work = process_at_work(folder);
  if (!at_work.process.empty()) {
    throw UserError("the output folder {} {} written by {}. Specify another --output.", folder.string(),
                    at_work.is_known ? "is being" : "may be being", at_work.process);
  }
  throw UserError(
      "the output folder {} contains another run. Specify another --output, or replace that run with --overwrite.",
      folder.string());
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
