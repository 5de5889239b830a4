// The bytes of a case file. A case that is sound must come back from its resolved text as the same text.
#include "config/describe.hpp"
#include "config/input_files.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace thawslide;
  // Beside the case: what its paths may name.
  static const bool beside = [] {
    fuzz::write("profile.csv", "distance_m,terrain_elevation_m,surface_elevation_m\n0,50,50\n50,20,40\n100,0,0\n");
    fuzz::write("targets.csv", "");
    for (const char* name : {"dem.tif", "release.geojson", "map.tif", "line.geojson"}) {
      fuzz::write(name, "");
    }
    fuzz::write("base.toml", "[time]\nend = 2.0\n[grid]\ncell = 5.0\n");
    return true;
  }();
  static_cast<void>(beside);
  const std::string file = fuzz::write("case.toml", {reinterpret_cast<const char*>(data), size});
  config::Case read;
  if (!fuzz::gives_value(fuzz::folder(), [&] { read = config::read_case(file); })) {
    return 0;
  }
  static_cast<void>(config::notices(read));
  static_cast<void>(config::input_files(read));
  const std::string resolved = config::resolved_toml(read, fuzz::folder());
  const std::string again = fuzz::write("resolved.toml", resolved);
  if (!fuzz::gives_value(again, [&] {
        if (config::resolved_toml(config::read_case(again), fuzz::folder()) != resolved) {
          fuzz::fail("the resolved case reads back as another one");
        }
      })) {
    fuzz::fail("the resolved case is refused");
  }
  return 0;
}
