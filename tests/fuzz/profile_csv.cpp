// Bytes of a terrain profile.
#include "config/profile_csv.hpp"

#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace thawslide;
  const std::string file = fuzz::write("profile.csv", {reinterpret_cast<const char*>(data), size});
  fuzz::gives_value(file, [&] {
    const config::ProfileTable profile = config::read_profile(file);
    const bool has_shape = profile.distance.size() >= 2 && profile.terrain.size() == profile.distance.size() &&
                           (profile.surface.empty() || profile.surface.size() == profile.distance.size());
    if (!has_shape) {
      fuzz::fail("columns of different length");
    }
    static_cast<void>(profile.terrain_at(0.5 * profile.distance.front() + 0.5 * profile.distance.back()));
  });
  return 0;
}
