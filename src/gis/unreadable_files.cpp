#include "gis/unreadable_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/shell_quote.hpp"
#include "base/text.hpp"

namespace thawslide::gis {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t head_bytes = 4096;  // of a file, which include the header of an ASCII grid

std::string head_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(head_bytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return head;
}

// First value of an ASCII grid, after lines of a keyword and a number; empty if the text is no ASCII grid.
std::string first_value(const std::string& head) {
  std::istringstream words(lower_case(head));
  std::string word, number;
  bool is_grid = false;
  while (words >> word) {
    const bool is_keyword = std::isalpha(static_cast<unsigned char>(word.front())) != 0 && word.rfind("nan", 0) != 0;
    if (!is_keyword) {
      return is_grid ? word : "";
    }
    is_grid = is_grid || word == "ncols" || word == "nrows";
    words >> number;
  }
  return "";
}

}  // namespace

std::string cause_of_unreadable_vector(const std::string& file) {
  const fs::path path(file);
  if (lower_case(path.extension().string()) != ".shp") {
    return "";
  }
  std::error_code ignored;
  for (const char* ending : {".shx", ".SHX"}) {
    if (fs::exists(fs::path(path).replace_extension(ending), ignored)) {
      return "";
    }
  }
  return fmt::format(
      "the index of the Shapefile, {}, is missing. Copy the .shx, .dbf and .prj file next to it, or restore the index: "
      "ogrinfo --config SHAPE_RESTORE_SHX YES {}",
      fs::path(path).replace_extension(".shx").filename().string(), shell_quote(file));
}

std::string cause_of_unreadable_raster(const std::string& file) {
  const std::string head = head_of(file);
  if (head.rfind("\xEF\xBB\xBF", 0) == 0) {
    return fmt::format(
        "the file begins with a UTF-8 byte order mark, which an ASCII grid may not have. Remove it: sed -i "
        "'1s/^\\xEF\\xBB\\xBF//' {}",
        shell_quote(file));
  }
  if (first_value(head).rfind("nan", 0) == 0) {
    return fmt::format(
        "the first value of the ASCII grid is nan, which GDAL does not read there. Write the number of NODATA_value in "
        "its place, for example -9999: sed -i 's/nan/-9999/gi' {}",
        shell_quote(file));
  }
  return "";
}

}  // namespace thawslide::gis
