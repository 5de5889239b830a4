// Changes to valid bytes, specified by a target's input: they reach more code than random bytes.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>

namespace thawslide::fuzz {

using Provider = FuzzedDataProvider;

inline bool chance(Provider& bytes, int of) { return bytes.ConsumeIntegralInRange(1, of) == 1; }

// The text with some of its bytes overwritten, or cut off.
inline std::string changed(std::string text, Provider& bytes) {
  while (bytes.remaining_bytes() > 0 && !text.empty()) {
    const auto place = bytes.ConsumeIntegralInRange<std::size_t>(0, text.size() - 1);
    const std::string put = bytes.ConsumeRandomLengthString(8);
    if (put.empty() && chance(bytes, 8)) {
      text.resize(place);
      continue;
    }
    for (std::size_t k = 0; k < put.size() && place + k < text.size(); ++k) {
      text[place + k] = put[k];
    }
  }
  return text;
}

}  // namespace thawslide::fuzz
