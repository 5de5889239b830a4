// The case.toml that a run writes, with every key in it: the bytes say which of its lines go, move or get another
// value, so that what is read stays TOML and reaches the checks.
#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <sstream>
#include <vector>

#include "../cpp/config/every_key.hpp"
#include "case_round_trip.hpp"

namespace {

using namespace thawslide;
using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

// Resolved cases of both dimensions, with every key between them.
const std::vector<Lines>& sound_cases() {
  static const std::vector<Lines> made = [] {
    std::vector<Lines> cases;
    fuzz::write_what_cases_name();
    for (const std::string& text :
         {config::every_key, config::rest_in_3d, config::release_on_dem, config::release_of_a_surface()}) {
      cases.push_back(lines_of(config::resolved_toml(config::read_case(fuzz::write("case.toml", text)), "inputs")));
    }
    return cases;
  }();
  return made;
}

std::string value_of(const std::string& line) {
  const std::size_t equals = line.find(" = ");
  return equals == std::string::npos ? line : line.substr(equals + 3);
}

void change(Lines& lines, FuzzedDataProvider& bytes) {
  const std::array<const char*, 24> values{"nan",
                                           "inf",
                                           "-inf",
                                           "0",
                                           "-0.0",
                                           "-1",
                                           "1",
                                           "1e308",
                                           "-1e308",
                                           "1e-308",
                                           "9223372036854775807",
                                           "3000000000",
                                           "2147483647",
                                           "\"\"",
                                           "\"x\"",
                                           "\"../profile.csv\"",
                                           "[]",
                                           "[[]]",
                                           "[0.0, 0.0]",
                                           "[1.0, 1.0, 1.0]",
                                           "{}",
                                           "true",
                                           "[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]",
                                           "{ time = [0.0, 1.0], value = [0.1, nan] }"};
  const auto any_line = [&] { return bytes.ConsumeIntegralInRange<std::size_t>(0, lines.size() - 1); };
  const std::size_t at = any_line();
  const auto replace = [&](const std::string& value) {
    const std::size_t equals = lines[at].find(" = ");
    if (equals != std::string::npos) {
      lines[at] = lines[at].substr(0, equals + 3) + value;
    }
  };
  switch (bytes.ConsumeIntegralInRange(0, 5)) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1:
      std::swap(lines[at], lines[any_line()]);
      break;
    case 2:
      replace(value_of(lines[any_line()]));
      break;
    case 3:
      replace(fmt::format("{}", bytes.ConsumeFloatingPoint<double>()));
      break;
    case 4:
      replace(bytes.ConsumeRandomLengthString(24));
      break;
    default:
      replace(bytes.PickValueInArray(values));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  const std::vector<Lines>& cases = sound_cases();
  Lines lines = cases[bytes.ConsumeIntegralInRange<std::size_t>(0, cases.size() - 1)];
  while (bytes.remaining_bytes() > 0 && lines.size() > 1) {
    change(lines, bytes);
  }
  fuzz::read_and_write_case(fmt::format("{}\n", fmt::join(lines, "\n")));
  return 0;
}
