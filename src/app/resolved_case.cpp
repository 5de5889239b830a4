#include "app/resolved_case.hpp"

#include "base/atomic_file.hpp"
#include "config/describe.hpp"
#include "config/input_files.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

std::vector<io::InputFile> write_resolved_case(const config::Case& parameters, const fs::path& folder) {
  std::vector<io::InputFile> inputs = io::copy_inputs(folder, config::input_files(parameters));
  write_file_atomically(folder / "case.toml", config::resolved_toml(parameters, "inputs"));
  return inputs;
}

}  // namespace thawslide::app
