// Who writes a run's folder: a process holds the lock as long as it lives, however it ends. On a file system without
// locks nobody is known to be at work.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace thawslide::io {

inline constexpr const char* lock_name = "run.lock";

class RunLock {
 public:
  // Throws UserError where another process holds the folder's lock, WriteError where the file cannot be made.
  explicit RunLock(const std::filesystem::path& folder);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  // Gives the folder free and removes the file; where the run has not come to its run.json the file stays, as a sign
  // that the folder holds no more than a start.
  ~RunLock();

 private:
  std::filesystem::path file_;
  int descriptor_;
};

// "process 123 on HOST" where one is at work in the folder, nothing else.
[[nodiscard]] std::optional<std::string> process_at_work(const std::filesystem::path& folder);

}  // namespace thawslide::io
