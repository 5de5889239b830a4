// Who writes a run's folder: a process holds the lock as long as it lives, however it ends. On a file system without
// locks its name in the file decides: of a process of this machine it is known whether it lives, one of another machine
// is taken to. A process that ends by itself takes its name out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace thawslide::io {

inline constexpr const char* lock_name = "run.lock";

class RunLock {
 public:
  // Throws UserError where another process holds the folder's lock, or may, and where what stands in its place is a
  // link or no regular file; WriteError where the file cannot be made.
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

// The folder of a run whose lock this process holds. It may be moved or removed meanwhile, and another run begin under
// its name, where this one then must not write.
class OwnFolder {
 public:
  explicit OwnFolder(const std::filesystem::path& folder);
  // Throws WriteError where it is not its own any more.
  void require() const;

 private:
  [[nodiscard]] bool is_own() const;

  std::filesystem::path lock_;
  std::uint64_t device_ = 0, inode_ = 0;
};

struct AtWork {
  bool is_known = true;  // false: there is a lock file, its file system has no locks, and what it says does not tell
  std::string process;   // "process 123 on HOST" that is at work in the folder, or that may be; empty: none is known to
};
// Throws UserError where a link, or no regular file, stands in the place of the lock, or it cannot be read.
[[nodiscard]] AtWork process_at_work(const std::filesystem::path& folder);

}  // namespace thawslide::io
