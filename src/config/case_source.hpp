// Texts from which a case is read: its files as they were when they were read, and replaced keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thawslide::config {

struct CaseFile {
  std::filesystem::path file;
  std::string text;
};

// One `--set key=value`: value is the text of a TOML value, or a bare word for a string.
struct Override {
  std::string key;
  std::string value;
  std::filesystem::path folder{};  // to which paths in the value are relative
};

}  // namespace thawslide::config
