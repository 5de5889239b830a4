// Errors. UserError, RunError and the like are always thrown; THAWSLIDE_ASSERT checks for defects of the program.
#pragma once

#ifdef __CUDACC__
#include <cassert>
#else
#include <fmt/format.h>
#endif

#include <stdexcept>
#include <string>

namespace thawslide {

// Exit codes of the program.
enum class ExitCode : int {
  done = 0,
  user_mistake = 2,
  run_failed = 3,
  stopped_by_signal = 4,
  not_written = 5,
  device_failed = 6
};

// Error of the user. The message states what was found, what is allowed and the remedy. Exit code 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// File that cannot be written: full disk, missing permission. A run aborts with exit code 5 and can be resumed.
class WriteError : public UserError {
 public:
  using UserError::UserError;
};

// GPU failure during a run, such as insufficient memory. The run aborts with exit code 6 and can be resumed.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Run that failed (not finite, outside the domain, inverted). The message names particle, place, time and probable
// cause. Exit code 3.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Defect of the program: an invariant does not hold.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void fail_assertion(const char* condition, const char* file, int line, const std::string& values);

}  // namespace thawslide

// Checks an invariant of the program. The further arguments (a fmt format and values) are added to the message; devices
// report only the condition.
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
