#include "app/resolved_case.hpp"

#include "config/describe.hpp"
#include "io/atomic_file.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

std::vector<io::InputFile> write_resolved_case(const config::Case& parameters, const fs::path& folder) {
  std::vector<fs::path> files(parameters.case_files.begin(), parameters.case_files.end());
  for (const std::string& file : {parameters.terrain.file, parameters.report.targets}) {
    if (!file.empty()) {
      files.emplace_back(file);
    }
  }
  std::vector<io::InputFile> inputs = io::copy_inputs(folder, files);
  io::write_file_atomically(folder / "case.toml", config::resolved_toml(parameters, "inputs"));
  return inputs;
}

}  // namespace thawslide::app
