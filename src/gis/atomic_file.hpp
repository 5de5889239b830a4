// File that is complete or absent: it is written under a temporary name in the same folder and then renamed.
#pragma once

#include <string>
#include <string_view>

namespace thawslide::gis {

class GdalMessages;

class AtomicFile {
 public:
  explicit AtomicFile(const std::string& file);
  ~AtomicFile();  // removes an unpublished temporary file
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Temporary path to write to; it has the file's own extension, which drivers check.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  // Synchronizes the file to disk and renames it. Throws WriteError with the system's reason.
  void publish();
  // Throws WriteError with the file and the reason.
  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void fail_with(const GdalMessages& messages) const;

 private:
  std::string file_, temporary_;
};

void write_text(const std::string& file, std::string_view text);

}  // namespace thawslide::gis
