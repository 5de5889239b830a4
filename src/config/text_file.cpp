#include "config/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "base/error.hpp"

namespace thawslide::config {

std::string read_text_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& reason) {
    throw UserError(
        fmt::format("{}: cannot be read: {}. Check that the file is whole and may be read.", file.string(), reason));
  };
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  try {
    text.assign(std::istreambuf_iterator<char>(stream), {});
  } catch (const std::ios_base::failure& error) {  // the stream iterator passes on read errors of the file
    fail(error.code().message());
  }
  if (!stream) {
    fail(errno != 0 ? std::strerror(errno) : "it cannot be opened");
  }
  return text;
}

}  // namespace thawslide::config
