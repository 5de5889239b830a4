// Bytes of a case file; the resolved text of a valid one must be resolved to the same text.

#include <string>

#include "config/describe.hpp"
#include "config/named_files.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "target.hpp"

namespace {

using namespace thawslide;

// Files that the paths of a case can name, in the folder itself and in that of a resolved case's inputs. Maps are
// opened when a run begins: here their existence is sufficient.
void write_what_cases_name() {
  static const bool done = [] {
    std::filesystem::create_directories(fuzz::folder() / "inputs");
    for (const std::string place : {"", "inputs/"}) {
      for (const std::string name :
           {"dem.tif", "release.geojson", "release.shp", "map.tif", "line.geojson", "path.geojson", "section.geojson",
            "thickness.tif", "saturation.tif", "before.tif", "codes.tif"}) {
        fuzz::write(place + name, "");
      }
      fuzz::write(place + "targets.csv", "quantity,time_s,value,unit,source\n");
      fuzz::write(place + "force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n1,0,0,0\n");
      fuzz::write(place + "profile.csv", "distance_m,terrain_elevation_m\n0,0\n50,-1\n");
    }
    fuzz::write("base.toml", "[time]\nend = 2.0\n[grid]\ncell = 5.0\n");
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  write_what_cases_name();
  const std::string file = fuzz::write("case.toml", {reinterpret_cast<const char*>(data), size});
  config::Case read;
  if (!fuzz::gives_value(fuzz::folder(), [&] { read = config::read_case(file); })) {
    return 0;
  }
  static_cast<void>(config::notices(read));
  static_cast<void>(config::named_files(read));
  const std::string resolved = config::resolved_toml(read, "inputs");
  const std::string again = fuzz::write("resolved.toml", resolved);
  const bool is_taken = fuzz::gives_value(again, [&] {
    if (config::resolved_toml(config::read_case(again), "inputs") != resolved) {
      fuzz::fail("the resolved case reads back as another one");
    }
  });
  if (!is_taken) {
    fuzz::fail("the resolved case is refused");
  }
  return 0;
}
