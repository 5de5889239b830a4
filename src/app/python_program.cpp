#include "app/python_program.hpp"

#include <unistd.h>

#include <filesystem>

namespace thawslide::app {

namespace fs = std::filesystem;

const char* const python_program_remedy =
    "It is part of the Python package: `./run --setup` installs it into .venv; put .venv/bin on PATH.";

std::string python_program(const std::string& name) {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  // The build folder of a checkout is build/PRESET.
  for (const fs::path& candidate : {folder / name, folder / ".." / ".." / ".venv" / "bin" / name}) {
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) {
      return candidate.string();
    }
  }
  return name;
}

}  // namespace thawslide::app
