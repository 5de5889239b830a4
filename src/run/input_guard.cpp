#include "run/input_guard.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "run/input_files.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

void require_readable_inputs(const config::Case& parameters) {
  for (const fs::path& input : input_files(parameters)) {
    const auto is_it = [&input](const config::CaseFile& each) { return each.file == input; };
    const bool was_read = std::any_of(parameters.case_files.begin(), parameters.case_files.end(), is_it);
    if (!was_read && access(input.c_str(), R_OK) != 0) {
      throw UserError("{} cannot be read: {}. A run keeps a copy of it.", input.string(), std::strerror(errno));
    }
  }
}

void require_no_input_in(const fs::path& folder, const config::Case& parameters) {
  const fs::path runs_folder = fs::weakly_canonical(folder);
  for (const fs::path& input : input_files(parameters)) {
    const fs::path relative = fs::weakly_canonical(input).lexically_relative(runs_folder);
    if (!relative.empty() && *relative.begin() != "..") {
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
