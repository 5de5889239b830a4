// Common parts of the targets: a folder for the input, changes to valid bytes, and the allowed results of a reader.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.hpp"

namespace thawslide::fuzz {

// A folder of this process, in memory if the system has a memory file system.
inline const std::filesystem::path& folder() {
  static const std::filesystem::path made = [] {
    const std::filesystem::path memory = "/dev/shm";
    std::filesystem::path path = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    path /= "thawslide-fuzz-" + std::to_string(getpid());
    std::filesystem::create_directories(path);
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(folder(), ignored);
    });
    return path;
  }();
  return made;
}

inline std::filesystem::path write(const std::string& name, std::string_view bytes) {
  std::filesystem::path file = folder() / name;
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "FINDING: %s\n", what.c_str());
  std::abort();
}

// Returns whether `read` returned a value. A reader may throw an error of the user that names a file; any other
// exception ends the process as a finding.
template <class Read>
bool gives_value(const std::string& file, const Read& read) {
  const auto specified = [&](const std::exception& error) {
    const std::string_view words(error.what());
    if (const auto* letter =
            std::find_if(words.begin(), words.end(), [](char l) { return l > 0 && l < ' ' && l != '\n'; });
        letter != words.end()) {
      fail(fmt::format("the message holds the control letter {:#x}: {}", *letter, words));
    }
    if (words.find(file) == std::string_view::npos) {
      fail(fmt::format("the message does not name {}: {}", file, words));
    }
    return false;
  };
  try {
    read();
    return true;
  } catch (const UserError& error) {
    return specified(error);
  } catch (const RunError& error) {
    return specified(error);
  }
}

using Provider = FuzzedDataProvider;

inline bool chance(Provider& bytes, int of) { return bytes.ConsumeIntegralInRange(1, of) == 1; }

// The text with some of its bytes overwritten, or cut off: such changes reach more code than random bytes.
inline std::string changed(std::string text, Provider& bytes) {
  while (bytes.remaining_bytes() > 0 && !text.empty()) {
    const auto place = bytes.ConsumeIntegralInRange<std::size_t>(0, text.size() - 1);
    const std::string put = bytes.ConsumeRandomLengthString(8);
    if (put.empty() && chance(bytes, 8)) {
      text.resize(place);
      continue;
    }
    for (std::size_t k = 0; k < put.size() && place + k < text.size(); ++k) {
      text[place + k] = put[k];
    }
  }
  return text;
}

}  // namespace thawslide::fuzz
