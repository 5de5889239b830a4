// How much more memory this process may take, as the system tells it.
#pragma once

#include <filesystem>
#include <string>

namespace thawslide {

struct AvailableMemory {
  double bytes = 0.0;
  std::string bound;  // what bounds it, in words that follow on an amount: "are free"
};

// The smallest of what the machine has free now, what a limit of address space leaves (ulimit -v), and what the control
// groups of this process leave (those of containers and batch systems). Swap does not count.
[[nodiscard]] AvailableMemory available_memory();

// What /proc/meminfo says may be taken without swapping [bytes]; not a number where it says nothing of the kind.
[[nodiscard]] double available_in(const std::string& meminfo);

// What control groups leave [bytes], by the text of /proc/self/cgroup and the folder they are mounted at; infinite
// where none bounds it. Pages of files that the system may drop count as free.
[[nodiscard]] double left_by_control_groups(const std::string& membership, const std::filesystem::path& mount);

}  // namespace thawslide
