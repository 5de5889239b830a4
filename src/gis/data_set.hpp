// Files of a raster or vector data set, which may be several.
#pragma once

#include <filesystem>
#include <vector>

namespace thawslide::gis {

// Existing files of the data set, beginning with `file`: those that GDAL lists, and those that it reads but does not
// list (edits of an open GeoPackage, parts of a Shapefile with suffixes in the other case). Only `file` if it is not a
// readable data set.
[[nodiscard]] std::vector<std::filesystem::path> files_of_data_set(const std::filesystem::path& file);

// File to open in place of `file`: a temporary copy of a GeoPackage with edits that are not in its file yet, because
// reading the original would move them there; otherwise the file itself.
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
