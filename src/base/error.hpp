// The two families of failure. UserError and RunError are thrown and always on; THAWSLIDE_ASSERT is for our own
// mistakes.
#pragma once

#ifdef __CUDACC__
#include <cassert>
#else
#include <fmt/format.h>
#endif

#include <stdexcept>
#include <string>

namespace thawslide {

// Exit codes of the program (ARCHITECTURE.md).
enum class ExitCode : int {
  done = 0,
  user_mistake = 2,
  run_failed = 3,
  stopped_by_signal = 4,
  not_written = 5,
  device_failed = 6
};

// The user's mistake: the message says what was found, what is allowed and what to do. Exit code 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that cannot be written: a full disk, no permission. A run that meets it ends with exit code 5 and can be
// resumed.
class WriteError : public UserError {
 public:
  using UserError::UserError;
};

// A card that failed amid a run: no memory left, or worse. A run that meets it ends with exit code 6 and can be
// resumed.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A run that failed (not finite, out of the domain, inverted): names particle, place, time and likely cause. Exit
// code 3.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Our own mistake: an invariant of the program does not hold.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void fail_assertion(const char* condition, const char* file, int line, const std::string& values);

}  // namespace thawslide

// Checks an invariant of the program; the further arguments (a fmt format and values) go into the message. Devices tell
// the condition alone.
#ifdef __CUDACC__
#define THAWSLIDE_ASSERT(condition, ...) assert(condition)
#else
#define THAWSLIDE_ASSERT(condition, ...)                                                       \
  do {                                                                                         \
    if (!(condition)) {                                                                        \
      ::thawslide::fail_assertion(#condition, __FILE__, __LINE__, ::fmt::format(__VA_ARGS__)); \
    }                                                                                          \
  } while (false)
#endif
