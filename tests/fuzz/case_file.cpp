// Bytes of a case file; the resolved text of a valid one must be resolved to the same text.

#include <string>

#include "config/describe.hpp"
#include "config/named_files.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "target.hpp"

namespace thawslide::fuzz {

namespace {

// Files that the paths of a case can name, in the folder itself and in that of a resolved case's inputs. Maps are
// opened when a run begins: here their existence is sufficient.
void write_what_cases_name() {
  static const bool done = [] {
    std::filesystem::create_directories(folder() / "inputs");
    for (const std::string place : {"", "inputs/"}) {
      for (const std::string name :
           {"dem.tif", "release.geojson", "release.shp", "map.tif", "line.geojson", "path.geojson", "section.geojson",
            "thickness.tif", "saturation.tif", "before.tif", "codes.tif"}) {
        write(place + name, "");
      }
      write(place + "targets.csv", "quantity,time_s,value,unit,source\n");
      write(place + "force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n1,0,0,0\n");
      write(place + "profile.csv", "distance_m,terrain_elevation_m\n0,0\n50,-1\n");
    }
    write("base.toml", "[time]\nend = 2.0\n[grid]\ncell = 5.0\n");
    return true;
  }();
  static_cast<void>(done);
}

void read_and_write_case(std::string_view text) {
  write_what_cases_name();
  const std::string file = write("case.toml", text);
  config::Case read;
  if (!gives_value(folder(), [&] { read = config::read_case(file); })) {
    return;
  }
  static_cast<void>(config::notices(read));
  static_cast<void>(config::named_files(read));
  const std::string resolved = config::resolved_toml(read, "inputs");
  const std::string again = write("resolved.toml", resolved);
  const bool is_taken = gives_value(again, [&] {
    if (config::resolved_toml(config::read_case(again), "inputs") != resolved) {
      fail("the resolved case reads back as another one");
    }
  });
  if (!is_taken) {
    fail("the resolved case is refused");
  }
}

}  // namespace

}  // namespace thawslide::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  thawslide::fuzz::read_and_write_case({reinterpret_cast<const char*>(data), size});
  return 0;
}
