#include "base/available_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

namespace thawslide {

namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Number at the start of a file; NaN without a file or a number ("max").
double number_in(const fs::path& file) {
  std::ifstream stream(file);
  double number = 0.0;
  return stream >> number ? number : std::nan("");
}

// Number after a word at the start of a line; NaN if there is none.
double number_after(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream parts(line);
    std::string first;
    double number = 0.0;
    if (parts >> first >> number && first == word) {
      return number;
    }
  }
  return std::nan("");
}

double left_in_group(const fs::path& folder) {
  const double limit = number_in(folder / "memory.max"), used = number_in(folder / "memory.current");
  if (std::isnan(limit) || std::isnan(used)) {
    return infinity;
  }
  const double droppable = number_after(text_of(folder / "memory.stat"), "inactive_file");
  return std::max(0.0, limit - used + (std::isnan(droppable) ? 0.0 : droppable));
}

double left_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return infinity;
  }
  const double pages_used = number_in("/proc/self/statm");
  const double in_use = std::isnan(pages_used) ? 0.0 : pages_used * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - in_use);
}

}  // namespace

double available_in(const std::string& meminfo) {
  constexpr double kibibyte = 1024.0;
  return kibibyte * number_after(meminfo, "MemAvailable:");
}

double left_by_control_groups(const std::string& membership, const fs::path& mount) {
  const std::size_t begin = membership.find("0::");
  if (begin == std::string::npos) {
    return infinity;
  }
  const std::string group = membership.substr(begin + 3, membership.find('\n', begin) - begin - 3);
  double left = left_in_group(mount);
  fs::path folder = mount;
  for (const fs::path& part : fs::path(group).relative_path()) {  // the limits of the parent groups apply too
    folder /= part;
    left = std::min(left, left_in_group(folder));
  }
  return left;
}

AvailableMemory available_memory() {
  const double free_now = available_in(text_of("/proc/meminfo"));
  const double whole = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  AvailableMemory least{std::isnan(free_now) ? whole : free_now, "are free"};
  const auto keep_smaller = [&least](double bytes, const char* bound) {
    if (bytes < least.bytes) {
      least = {bytes, bound};
    }
  };
  keep_smaller(left_by_control_groups(text_of("/proc/self/cgroup"), "/sys/fs/cgroup"),
               "are left by the bound of a control group (of a container or a batch system)");
  keep_smaller(left_of_address_space(), "are left by the bound of ulimit -v");
  return least;
}

}  // namespace thawslide
