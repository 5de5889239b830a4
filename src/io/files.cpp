#include "io/files.hpp"

#include <openssl/evp.h>
#include <unistd.h>

#include <vector>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "config/input_limits.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw WriteError("cannot make the folder {}: {}", folder.string(), error.message());
  }
}

fs::path name_for_damaged(const fs::path& file) {
  const std::string stem = (file.parent_path() / file.stem()).string(), extension = file.extension().string();
  fs::path free = stem + ".damaged" + extension;
  for (int number = 2; fs::exists(free); ++number) {
    free = fmt::format("{}.damaged.{}{}", stem, number, extension);
  }
  return free;
}

void remove_unfinished_files(const fs::path& folder) {
  if (fs::is_symlink(folder) || !fs::is_directory(folder)) {
    return;
  }
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_unfinished(entry.path()) && entry.symlink_status().type() == fs::file_type::regular) {
      found.push_back(entry.path());
    }
  }
  for (const fs::path& file : found) {
    remove_or_throw(file);
  }
}

void remove_or_throw(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) {
    throw WriteError("cannot remove {}: {}. Check that the folder may be written to.", file.string(), error.message());
  }
}

std::string read_file(const fs::path& file) {
  require_regular(file);
  return config::read_text_file(file);
}

void require_regular(const fs::path& file) {
  if (const std::string found = config::other_kind_of_file(file); !found.empty()) {
    throw UserError("{} is {}; a regular file is needed. Replace it by the file itself, or remove it.", file.string(),
                    found);
  }
}

std::string host_name() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

Digest sha256(std::string_view text) {
  Digest digest{};
  unsigned int length = 0;
  const int success = EVP_Digest(text.data(), text.size(), digest.data(), &length, EVP_sha256(), nullptr);
  THAWSLIDE_ASSERT(success == 1 && length == digest.size(), "SHA-256 of {} bytes failed", text.size());
  return digest;
}

std::string sha256_hex(std::string_view text) {
  std::string digits;
  for (const unsigned char byte : sha256(text)) {
    digits += fmt::format("{:02x}", byte);
  }
  return digits;
}

}  // namespace thawslide::io
