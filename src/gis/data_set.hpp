// Files of a raster or vector data set, which may be several.
#pragma once

#include <filesystem>
#include <vector>

namespace thawslide::gis {

// Files of the data set, beginning with `file`: those that GDAL lists, and those that it only reads, such as edits.
[[nodiscard]] std::vector<std::filesystem::path> files_of_data_set(const std::filesystem::path& file);

// File to open in place of `file`: a copy of a GeoPackage with edits, which reading would move to it; otherwise itself.
class ReadableFile {
 public:
  explicit ReadableFile(const std::filesystem::path& file);
  ~ReadableFile();
  ReadableFile(const ReadableFile&) = delete;
  ReadableFile& operator=(const ReadableFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_;  // of the copy; empty: none
  std::filesystem::path path_;
};

}  // namespace thawslide::gis
