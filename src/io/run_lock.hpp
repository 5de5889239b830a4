// Lock of a run folder, which a process holds until it ends. On a file system without locks, the process name in the
// file decides; one on another machine counts as running. A process that ends normally removes its entry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace thawslide::io {

inline constexpr const char* lock_name = "run.lock";

class RunLock {
 public:
  // Throws UserError if another process holds the lock, or may hold it; WriteError if the file cannot be created.
  explicit RunLock(const std::filesystem::path& folder);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  // Removes the file, unless the run has not written run.json: then it marks a folder without results.
  ~RunLock();

 private:
  std::filesystem::path file_;
  int descriptor_;
};

// Run folder whose lock this process holds, unless it was moved or removed, and another run has its name.
class OwnFolder {
 public:
  explicit OwnFolder(const std::filesystem::path& folder);
  // Throws WriteError if the folder no longer belongs to this run.
  void require() const;

 private:
  [[nodiscard]] bool is_own() const;

  std::filesystem::path lock_;
  std::uint64_t device_ = 0, inode_ = 0;
};

// "process 123 on HOST" that works in the folder; empty: none. Throws UserError if the lock cannot be read.
[[nodiscard]] std::string process_at_work(const std::filesystem::path& folder);

}  // namespace thawslide::io
