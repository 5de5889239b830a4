// The bytes of a case file.
#include "case_round_trip.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  thawslide::fuzz::read_and_write_case({reinterpret_cast<const char*>(data), size});
  return 0;
}
