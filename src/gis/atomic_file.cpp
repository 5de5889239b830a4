#include "gis/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "gis/gdal_messages.hpp"

namespace thawslide::gis {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(const std::string& file) : file_(file) {
  const fs::path path(file);
  temporary_ = (path.parent_path() / fmt::format(".{}.{}.thawslide-part{}", path.stem().string().substr(0, 200),
                                                 getpid(), path.extension().string()))
                   .string();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::fail(const std::string& reason) const {
  throw WriteError(fmt::format(
      "cannot write {}: {}. Check that the folder exists and is writable, and that the disk has free space.", file_,
      reason));
}

void AtomicFile::fail_with(const GdalMessages& messages) const {
  fail(messages.remark().empty() ? "for a reason that GDAL does not report" : messages.remark().substr(2));
}

void AtomicFile::publish() {
  const int descriptor = open(temporary_.c_str(), O_RDONLY);
  if (descriptor < 0) {
    fail(std::strerror(errno));
  }
  const bool on_disk = fsync(descriptor) == 0;
  const int reason = errno;
  close(descriptor);
  if (!on_disk) {
    fail(std::strerror(reason));
  }
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) {
    fail(std::strerror(errno));
  }
}

void write_text(const std::string& file, std::string_view text) {
  AtomicFile whole(file);
  errno = 0;
  std::ofstream stream(whole.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    whole.fail(std::strerror(errno));
  }
  whole.publish();
}

}  // namespace thawslide::gis
