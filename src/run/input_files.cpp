#include "run/input_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include "base/error.hpp"
#include "config/input_limits.hpp"
#include "config/named_files.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/data_set.hpp"
#endif

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_of(const config::InputFile& input) {
#ifdef THAWSLIDE_WITH_GIS
  if (input.is_map) {
    return gis::files_of_data_set(input.file);
  }
#endif
  return {input.file};
}

}  // namespace

std::vector<fs::path> input_files(const config::Case& parameters) {
  std::vector<fs::path> files;
  std::map<fs::path, fs::path> by_name;
  for (const config::InputFile& input : config::named_files(parameters)) {
    for (const fs::path& file : files_of(input)) {
      const auto [found, is_new] = by_name.insert({file.filename(), file});
      if (is_new) {
        files.push_back(file);
      } else if (found->second != file) {
        throw UserError(
            "{} and {} have the same name; allowed: names of their own, since a run keeps copies of all its inputs in "
            "one folder. Rename one.",
            found->second.string(), file.string());
      }
    }
  }
  return files;
}

void require_readable_inputs(const config::Case& parameters) {
  for (const fs::path& input : input_files(parameters)) {
    const auto is_it = [&input](const config::CaseFile& each) { return each.file == input; };
    const bool was_read = std::ranges::any_of(parameters.case_files, is_it);
    if (!was_read && access(input.c_str(), R_OK) != 0) {
      throw UserError("{} cannot be read: {}. A run keeps a copy of it.", input.string(), std::strerror(errno));
    }
  }
}

void require_no_input_in(const fs::path& folder, const config::Case& parameters) {
  for (const fs::path& input : input_files(parameters)) {
    if (config::lies_within(input, folder)) {
      throw UserError("{} lies in the output folder {}. Give another --output{}.", input.string(), folder.string(),
                      fs::exists(folder / "run.json") ? ", or continue that run: thawslide resume" : "");
    }
  }
}

void require_no_input_at(const fs::path& file, const std::string& option, const config::Case& parameters) {
  for (const fs::path& input : input_files(parameters)) {
    std::error_code not_there;
    if (fs::equivalent(file, input, not_there)) {
      throw UserError("{} {} is an input of the case, which it would replace. Give another file.", option,
                      file.string());
    }
  }
}

}  // namespace thawslide::run
