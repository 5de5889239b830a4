#include "config/input_limits.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.hpp"
#include "base/rounding.hpp"

namespace thawslide::config {

namespace fs = std::filesystem;

void require_size(const fs::path& file, double max_bytes, const std::string& advice) {
  std::error_code unknown;
  const auto bytes = static_cast<double>(fs::file_size(file, unknown));
  if (!unknown && bytes > max_bytes) {
    throw UserError("{}: the file has {} MB; allowed: {} MB. {}", file.string(), rounded_text(bytes / 1e6, 4),
                    count_text(max_bytes / 1e6), advice);
  }
}

std::string read_text_file(const fs::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::string text(stream ? static_cast<std::size_t>(stream.tellg()) : 0, '\0');
  stream.seekg(0).read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream) {
    throw UserError("{}: cannot be read: {}. Check that the file is whole and may be read.", file.string(),
                    std::strerror(errno));
  }
  return text;
}

std::string printable(std::string text, std::string_view kept) {
  std::replace_if(
      text.begin(), text.end(),
      [kept](char letter) {
        const auto code = static_cast<unsigned char>(letter);
        return (code < 0x20 && kept.find(letter) == std::string_view::npos) || code == 0x7f;
      },
      '?');
  constexpr const char* turning[] = {"\u202a", "\u202b", "\u202c", "\u202d", "\u202e",
                                     "\u2066", "\u2067", "\u2068", "\u2069"};
  for (const std::string_view mark : turning) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
      text.replace(at, mark.size(), "?");
    }
  }
  return text;
}

std::string shown(const std::string& text) {
  const std::string plain = printable(text.substr(0, most_letters_quoted));
  return text.size() > most_letters_quoted ? plain + "..." : plain;
}

std::vector<std::string> names_in(const fs::path& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (ending.empty() || entry->path().extension() == ending) {
      names.push_back(entry->path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string other_kind_of_file(const fs::path& path) {
  std::error_code unknown;
  switch (fs::status(path, unknown).type()) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "";
  }
}

bool lies_within(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path whole = folder.empty() ? fs::path(".") : folder;  // for a bare name
  const fs::path inside = fs::weakly_canonical(path, error).lexically_relative(fs::weakly_canonical(whole, error));
  return !inside.empty() && *inside.begin() != "..";
}

}  // namespace thawslide::config
