// Errors. UserError, RunError and the like are always thrown; THAWSLIDE_ASSERT checks for defects of the program.
#pragma once

#ifdef __CUDACC__
#include <cassert>
#else
#include <fmt/format.h>
#endif

#include <stdexcept>
#include <string>
#include <utility>

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

// Exception with a text, or with a format of fmt and its values.
class FormattedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
#ifndef __CUDACC__
  template <class... Values>
  requires(sizeof...(Values) > 0) explicit FormattedError(fmt::format_string<Values...> form, Values&&... values)
      : std::runtime_error(fmt::format(form, std::forward<Values>(values)...)) {}
#endif
};

// Error of the user. The message states what was found, what is allowed and the remedy. Exit code 2.
class UserError : public FormattedError {
 public:
  using FormattedError::FormattedError;
};

// File that cannot be written: full disk, missing permission. A run aborts with exit code 5 and can be resumed.
class WriteError : public UserError {
 public:
  using UserError::UserError;
};

// GPU failure during a run, such as insufficient memory. The run aborts with exit code 6 and can be resumed.
class DeviceError : public FormattedError {
 public:
  using FormattedError::FormattedError;
};

// Run that failed (not finite, outside, inverted), with particle, place, time and probable cause. Exit code 3.
class RunError : public FormattedError {
 public:
  using FormattedError::FormattedError;
};

// Defect of the program: an invariant does not hold.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn, gnu::noinline, gnu::cold]] inline void fail_assertion(const char* condition, const char* file, int line,
                                                                  const std::string& values) {
  using namespace std::string_literals;
  throw InternalError(file + ":"s + std::to_string(line) + ": internal error: '" + condition +
                      "' does not hold: " + values);
}

}  // namespace thawslide

// Checks an invariant of the program. Further arguments are a fmt format and values; devices report only the condition.
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
