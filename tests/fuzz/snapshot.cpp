// Changes to the bytes of a snapshot, or all of them: what a resume reads of those that it finds.
#include "io/snapshot.hpp"

#include "changes.hpp"
#include "io/snapshot_series.hpp"
#include "target.hpp"

namespace {

using namespace thawslide;

std::string sound() {
  mpm::Particles<3, double> particles;
  particles.resize(5);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.id(p) = static_cast<std::int64_t>(p);
  }
  const std::vector<std::byte> bytes =
      io::snapshot_bytes(io::take_snapshot<3, double>(particles, Vector<double, 3>::Zero(), 0.5, 100));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const std::string whole = sound();
  fuzz::Provider bytes(data, size);
  const std::string text =
      bytes.ConsumeIntegralInRange(0, 15) > 0 ? fuzz::changed(whole, bytes) : bytes.ConsumeRemainingBytesAsString();
  const std::filesystem::path folder = fuzz::folder() / "run";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "snapshots");
  fuzz::write("run/snapshots/000000.vtkhdf", text);
  fuzz::gives_value(folder, [&] {
    std::vector<std::string> warnings;
    io::SnapshotSeries series = io::SnapshotSeries::continue_after(folder, 1, warnings);
    series.write_index();  // virtual datasets over what could be read
    if (warnings.empty() != std::filesystem::exists(folder / "particles.vtkhdf")) {
      fuzz::fail("a snapshot that is neither told of nor in the index");
    }
  });
  return 0;
}
