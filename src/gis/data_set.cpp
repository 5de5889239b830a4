#include "gis/data_set.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/raster_file.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace fs = std::filesystem;

namespace {

// Files of SQLite next to a GeoPackage, with edits that are not in it yet, or that are to be removed from it.
std::vector<fs::path> edits_of(const fs::path& file) {
  std::vector<fs::path> edits;
  for (const char* ending : {"-wal", "-journal"}) {
    std::error_code ignored;
    if (fs::path edit = file.string() + ending; fs::is_regular_file(edit, ignored)) {
      edits.push_back(std::move(edit));
    }
  }
  return edits;
}

}  // namespace

ReadableFile::ReadableFile(const fs::path& file) : path_(file) {
  const std::vector<fs::path> edits = edits_of(file);
  if (edits.empty()) {
    return;
  }
  try {
    std::string name = (fs::temp_directory_path() / "thawslide-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw fs::filesystem_error("", std::error_code(errno, std::generic_category()));
    }
    folder_ = name;
    path_ = folder_ / file.filename();
    fs::copy_file(file, path_);
    for (const fs::path& edit : edits) {
      fs::copy_file(edit, folder_ / edit.filename());
    }
  } catch (const fs::filesystem_error& error) {
    throw UserError(
        "{}: it cannot be copied to read its latest edits ({}). Save them, and close the file in other programs.",
        file.string(), error.code().message());
  }
}

ReadableFile::~ReadableFile() {
  if (!folder_.empty()) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
}

std::vector<fs::path> files_of_data_set(const fs::path& file) {
  const GdalMessages messages;
  const ReadableFile readable(file);
  std::vector<fs::path> files{file};
  const auto add = [&files](const fs::path& other) {
    std::error_code ignored;
    const auto is_it = [&](const fs::path& each) { return fs::equivalent(each, other, ignored); };
    if (fs::is_regular_file(other, ignored) && std::ranges::none_of(files, is_it)) {
      files.push_back(other);
    }
  };
  for (const auto& [kind, formats] :
       {std::pair(GDAL_OF_RASTER, raster_formats()), std::pair(GDAL_OF_VECTOR, vector_formats())}) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(readable.path().c_str(), kind | GDAL_OF_READONLY, formats));
    if (dataset != nullptr) {
      char** const listed = dataset->GetFileList();
      for (char** each = listed; each != nullptr && *each != nullptr; ++each) {
        add(file.parent_path() / fs::path(*each).filename());
      }
      CSLDestroy(listed);
    }
  }
  for (const fs::path& edit : edits_of(file)) {
    add(edit);
  }
  if (lower_case(file.extension().string()) == ".shp") {  // GDAL also reads suffixes in the other case
    for (const char* ending : {".shx", ".dbf", ".prj", ".cpg", ".SHX", ".DBF", ".PRJ", ".CPG"}) {
      add(fs::path(file).replace_extension(ending));
    }
  }
  return files;
}

}  // namespace thawslide::gis
