// Who writes a run's folder: a process holds the lock as long as it lives, however it ends. On a file system without
// locks a run goes on all the same, and whether one is at work cannot be told.
#pragma once

#include <filesystem>
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

struct AtWork {
  bool is_known = true;  // false: there is a lock file, and its file system has no locks
  std::string process;   // "process 123 on HOST" that is at work in the folder; empty: none is known to be
};
[[nodiscard]] AtWork process_at_work(const std::filesystem::path& folder);

}  // namespace thawslide::io
