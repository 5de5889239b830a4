// A file that is whole or not there: written beside its place, then renamed onto it.
#pragma once

#include <string>
#include <string_view>

namespace thawslide::gis {

class GdalMessages;

class AtomicFile {
 public:
  explicit AtomicFile(const std::string& file);
  ~AtomicFile();  // removes what was not put in place
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Where to write; it has the file's own extension, which drivers look at.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  // Makes sure that it is on the disk, and renames it. Throws WriteError with the system's reason.
  void publish();
  // Throws WriteError: cannot write FILE, and why.
  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void fail_with(const GdalMessages& messages) const;

 private:
  std::string file_, temporary_;
};

void write_text(const std::string& file, std::string_view text);

}  // namespace thawslide::gis
