// Memory available to this process, as reported by the system.
#pragma once

#include <filesystem>
#include <string>

namespace thawslide {

struct AvailableMemory {
  double bytes = 0.0;
  std::string bound;  // the limiting bound, as words that follow an amount: "are free"
};

// Minimum of the free memory of the machine, the remaining address space (ulimit -v), and the memory left by the
// control groups of this process (containers and batch systems). Excludes swap.
[[nodiscard]] AvailableMemory available_memory();

// Memory available without swapping according to /proc/meminfo [bytes]; NaN if not stated.
[[nodiscard]] double available_in(const std::string& meminfo);

// Memory left by control groups [bytes], from the text of /proc/self/cgroup and the mount folder; infinite without a
// limit, and for control groups of the first version. File pages that the system may drop count as free.
[[nodiscard]] double left_by_control_groups(const std::string& membership, const std::filesystem::path& mount);

}  // namespace thawslide
