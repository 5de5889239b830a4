// Bytes of a file of reported values.
#include <cmath>

#include "config/reported_values.hpp"
#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace thawslide;
  const std::string file = fuzz::write("targets.csv", {reinterpret_cast<const char*>(data), size});
  fuzz::gives_value(file, [&] {
    const config::ReportedValues reported = config::read_reported_values(file);
    for (const std::string& mistake : reported.mistakes) {
      if (mistake.find(file) == std::string::npos) {
        fuzz::fail("a mistake does not name the file: " + mistake);
      }
    }
    for (const config::ReportedValue& value : reported.values) {
      if (!std::isfinite(value.time) || !config::is_reported_quantity(value.quantity)) {
        fuzz::fail("a value of no quantity, or of no time");
      }
    }
  });
  return 0;
}
