// SHA-256, for provenance of inputs and for integrity of checkpoints.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace thawslide::io {

using Digest = std::array<unsigned char, 32>;

Digest sha256(const void* data, std::size_t bytes);
// As 64 hexadecimal digits.
std::string sha256_hex(const void* data, std::size_t bytes);

}  // namespace thawslide::io
