// The bytes of a run.json.
#include "io/provenance.hpp"
#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace thawslide;
  const std::string file = fuzz::write("run.json", {reinterpret_cast<const char*>(data), size});
  fuzz::gives_value(file, [] {
    const io::Provenance facts = io::read_provenance(fuzz::folder());
    if (facts.parts.empty()) {
      fuzz::fail("a run of no part");
    }
  });
  return 0;
}
