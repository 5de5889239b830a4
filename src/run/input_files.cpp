#include "run/input_files.hpp"

#include <map>

#include "base/error.hpp"
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

}  // namespace thawslide::run
