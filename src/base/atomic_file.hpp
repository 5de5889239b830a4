// File that is complete or absent: it is written under a temporary name in the same folder and then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace thawslide {

class AtomicFile {
 public:
  // Removes what has the temporary name: a file of a terminated process, or a link to another place.
  explicit AtomicFile(std::filesystem::path file);
  ~AtomicFile();  // removes an unpublished temporary file
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Path to write to, .NAME.PROCESS.thawslide-part in the same folder, with the file's own extension, for GDAL.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  // Creates the temporary file with this content. Throws WriteError with the system's reason.
  void write(const void* data, std::size_t bytes);
  // Synchronizes the file to disk and renames it; an existing one is kept as `previous`. Throws WriteError.
  void publish(const std::filesystem::path& previous = {});
  // Throws WriteError with the file and the reason.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::filesystem::path file_, temporary_;
};

// Writes and publishes a file with this content.
void write_file_atomically(const std::filesystem::path& file, const void* data, std::size_t bytes,
                           const std::filesystem::path& previous = {});
void write_file_atomically(const std::filesystem::path& file, std::string_view text,
                           const std::filesystem::path& previous = {});

// True for the name of a temporary file. No file of a user has such a name, because copy_inputs refuses it.
[[nodiscard]] bool is_unfinished(const std::filesystem::path& file);

}  // namespace thawslide
