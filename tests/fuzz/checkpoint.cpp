// The bytes of a checkpoint before its checksum, which is made to fit: what is parsed is whatever there is. The first
// byte says whether the others are all of it, or changes to a sound one of two or three dimensions.
#include "io/checkpoint.hpp"

#include "changes.hpp"
#include "io/files.hpp"
#include "io/sha256.hpp"
#include "target.hpp"

namespace {

using namespace thawslide;

constexpr std::size_t at_start = 3;  // particles

template <int Dim>
std::string sound() {
  static const std::string made = [] {
    mpm::Particles<Dim, double> particles;
    particles.resize(at_start);
    for (std::size_t p = 0; p < at_start; ++p) {
      particles.id(p) = static_cast<std::int64_t>(p);
    }
    io::write_checkpoint<Dim, double>(fuzz::folder(), particles, at_start, {0.5, 0.01, 0.0},
                                      {{"maps", {2.0, 2.0}}, {"centre_way", {}}});
    const std::string whole = io::read_file(fuzz::folder() / io::checkpoint_name);
    return whole.substr(0, whole.size() - sizeof(io::Digest));
  }();
  return made;
}

template <int Dim>
void read(const std::string& bytes) {
  const io::WholeCheckpoint checkpoint{fuzz::folder() / io::checkpoint_name, bytes, ""};
  fuzz::gives_value(checkpoint.file, [&] {
    mpm::Particles<Dim, double> particles;
    particles.resize(at_start);
    std::vector<double> scalars;
    static_cast<void>(io::read_checkpoint<Dim, double>(checkpoint, particles, scalars));
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  fuzz::Provider changes(data + 1, size - 1);
  std::string bytes = data[0] == '2'   ? fuzz::changed(sound<2>(), changes)
                      : data[0] == '3' ? fuzz::changed(sound<3>(), changes)
                                       : changes.ConsumeRemainingBytesAsString();
  const io::Digest digest = io::sha256(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(digest.data()), digest.size());
  read<2>(bytes);
  read<3>(bytes);
  return 0;
}
