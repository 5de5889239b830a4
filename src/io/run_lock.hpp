// Lock of a run folder: a process holds it until it ends, for any reason. On a file system without locks, the process
// name in the file decides. A process on this machine is tested; one on another machine counts as running. A process
// that ends normally removes its entry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace thawslide::io {

inline constexpr const char* lock_name = "run.lock";

class RunLock {
 public:
  // Throws UserError if another process holds the folder's lock, or may hold it; WriteError if the file cannot be
  // created.
  explicit RunLock(const std::filesystem::path& folder);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  // Releases the folder and removes the file. If the run has not written run.json, the file is kept to mark a folder
  // without results.
  ~RunLock();

 private:
  std::filesystem::path file_;
  int descriptor_;
};

// Run folder whose lock this process holds. If the folder was moved or removed and another run started under its name,
// this run must not write there.
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
