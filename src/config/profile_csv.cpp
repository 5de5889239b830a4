#include "config/profile_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"

namespace thawslide::config {

namespace {

using Fields = std::vector<std::string>;

// [m]: closer points would coincide in the coordinates of the domain.
constexpr double least_profile_step = 1e-6;

const Fields all_columns{"distance_m", "terrain_elevation_m", "surface_elevation_m"};

Fields split_at_commas(const std::string& line) {
  Fields fields;
  std::istringstream stream(line + ",");
  for (std::string field; std::getline(stream, field, ',');) {
    fields.push_back(trimmed(field));
  }
  return fields;
}

class ProfileReader {
 public:
  explicit ProfileReader(std::string file) : file_(std::move(file)) {}

  ProfileTable read() {
    require_size(file_, largest_table_file, "A DEM is read with terrain.type = \"dem\".");
    std::ifstream stream(file_, std::ios::binary);
    std::string line;
    while (std::getline(stream, line)) {
      ++line_;
      if (line_ == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) {  // a byte order mark
        line.erase(0, 3);
      }
      const std::string text = trimmed(line);
      if (text.empty() || text.front() == '#') {
        continue;
      }
      const Fields fields = split_at_commas(text);
      columns_ == 0 ? read_header(fields) : read_row(fields);
    }
    if (!stream.eof()) {
      throw UserError("{}: the profile cannot be read. Check that the file is there and may be read.", file_);
    }
    if (columns_ == 0) {
      fail("the file holds no header; allowed: distance_m,terrain_elevation_m[,surface_elevation_m]");
    }
    if (table_.distance.size() < 2) {
      fail("the profile has {} rows; a profile needs at least 2", table_.distance.size());
    }
    return std::move(table_);
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> message, Args&&... args) const {
    throw UserError("{}:{}: {}.", file_, std::max(line_, 1), fmt::format(message, std::forward<Args>(args)...));
  }

  void read_header(const Fields& fields) {
    const bool is_known =
        (fields.size() == 2 || fields.size() == 3) && std::equal(fields.begin(), fields.end(), all_columns.begin());
    if (!is_known) {
      fail(
          "the header is '{}'; allowed: distance_m,terrain_elevation_m[,surface_elevation_m], separated by "
          "commas. A DEM is read with terrain.type = \"dem\"",
          shown(fmt::format("{}", fmt::join(fields, ","))));
    }
    columns_ = fields.size();
  }

  void read_row(const Fields& fields) {
    if (fields.size() != columns_) {
      fail("the row has {} fields; the header has {}{}", fields.size(), columns_,
           fields.size() == 2 * columns_ ? ". Write decimal points, not commas" : "");
    }
    const double distance = number(fields[0], 0);
    const double terrain = number(fields[1], 1);
    if (!table_.distance.empty() && !(distance > table_.distance.back())) {
      fail(
          "the profile folds back: distance_m is {} after {}; allowed: strictly increasing distances. Sort "
          "the rows, and leave out overhangs and repeated points",
          distance, table_.distance.back());
    }
    if (!table_.distance.empty() && distance - table_.distance.back() < least_profile_step) {
      fail("distance_m is {} after {}; allowed: steps of {:g} m and more. Leave one of the two points out", distance,
           table_.distance.back(), least_profile_step);
    }
    table_.distance.push_back(distance);
    table_.terrain.push_back(terrain);
    if (columns_ == 3) {
      const double surface = number(fields[2], 2);
      if (surface < terrain) {
        fail(
            "surface_elevation_m is {}, below terrain_elevation_m, {}; allowed: the same elevation or a "
            "higher one",
            surface, terrain);
      }
      table_.surface.push_back(surface);
    }
  }

  double number(const std::string& field, std::size_t column) const {
    const char* begin = field.data() + (field.rfind('+', 0) == 0 ? 1 : 0);
    const char* end = field.data() + field.size();
    double value = 0.0;
    const auto result = std::from_chars(begin, end, value);
    if (result.ptr != end || result.ec != std::errc() || !std::isfinite(value)) {
      fail("{} is '{}'; allowed: a finite number with a decimal point", all_columns[column], shown(field));
    }
    return value;
  }

  std::string file_;
  int line_ = 0;
  std::size_t columns_ = 0;
  ProfileTable table_;
};

}  // namespace

double ProfileTable::terrain_at(double x) const {
  const auto after = std::upper_bound(distance.begin() + 1, distance.end() - 1, x);
  const auto k = static_cast<std::size_t>(after - distance.begin());
  const double t = (x - distance[k - 1]) / (distance[k] - distance[k - 1]);
  return terrain[k - 1] + t * (terrain[k] - terrain[k - 1]);
}

ProfileTable read_profile(const std::filesystem::path& file) { return ProfileReader(file.string()).read(); }

}  // namespace thawslide::config
