// The bytes of a checkpoint before its checksum, which is made to fit: what is parsed is whatever there is.
#include "io/checkpoint.hpp"

#include "io/sha256.hpp"
#include "target.hpp"

namespace {

using namespace thawslide;

constexpr std::size_t at_start = 3;  // particles, in the corpus too

template <int Dim>
void read(const io::WholeCheckpoint& checkpoint) {
  fuzz::gives_value(checkpoint.file, [&] {
    mpm::Particles<Dim, double> particles;
    particles.resize(at_start);
    std::vector<double> scalars;
    static_cast<void>(io::read_checkpoint<Dim, double>(checkpoint, particles, scalars));
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  const io::Digest digest = io::sha256(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(digest.data()), digest.size());
  const io::WholeCheckpoint checkpoint{fuzz::folder() / io::checkpoint_name, bytes, ""};
  read<2>(checkpoint);
  read<3>(checkpoint);
  return 0;
}
