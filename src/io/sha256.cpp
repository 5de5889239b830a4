#include "io/sha256.hpp"

#include <openssl/evp.h>

#include "base/error.hpp"

namespace thawslide::io {

Digest sha256(const void* data, std::size_t bytes) {
  Digest digest{};
  unsigned int length = 0;
  const int success = EVP_Digest(data, bytes, digest.data(), &length, EVP_sha256(), nullptr);
  THAWSLIDE_ASSERT(success == 1 && length == digest.size(), "SHA-256 of {} bytes failed", bytes);
  return digest;
}

std::string sha256_hex(const void* data, std::size_t bytes) {
  std::string text;
  for (const unsigned char byte : sha256(data, bytes)) {
    text += fmt::format("{:02x}", byte);
  }
  return text;
}

}  // namespace thawslide::io
