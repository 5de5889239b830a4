// Memory available to this process, as reported by the system.
#pragma once

#include <filesystem>
#include <string>

namespace thawslide {

struct AvailableMemory {
  double bytes = 0.0;
  std::string bound;  // the limiting bound, as words that follow an amount: "are free"
};

// Minimum of the free memory without swap, the remaining address space (ulimit -v), and that left by control groups.
[[nodiscard]] AvailableMemory available_memory();

// Memory available without swapping according to /proc/meminfo [bytes]; NaN if not stated.
[[nodiscard]] double available_in(const std::string& meminfo);

// Memory left by control groups of version 2 [bytes], without droppable file pages; infinite without a limit.
[[nodiscard]] double left_by_control_groups(const std::string& membership, const std::filesystem::path& mount);

}  // namespace thawslide
