// A library for LD_PRELOAD that makes calls fail which change what is on the disk, as a full disk does: to try what a
// program makes of it. Only calls on files below one folder count.
//
//   FAULT_FOLDER  calls on what lies below it count, from 1
//   FAULT_AT      the call that fails; 0 or absent: none
//   FAULT_KIND    once (that call alone, the default), onwards (all from there on), short (half of what is written
//                 arrives, later ones fail)
//   FAULT_REASON  full (no space left, the default), io (input/output error), denied (permission denied), or an
//                 exception: std (a std::exception) or other
//   FAULT_LOCKS   absent: there are no locks, as on some network disks, whatever the folder
//   FAULT_COUNT   file, outside of the folder, that the number of calls is written to at the end
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace {

enum class Kind { once, onwards, short_write };

struct Plan {
  std::string folder, count_file;
  long at = 0;
  Kind kind = Kind::once;
  int reason = ENOSPC;
  std::string exception;
  std::atomic<long> calls{0};

  Plan() {
    const auto text = [](const char* name) {
      const char* value = std::getenv(name);
      return std::string(value == nullptr ? "" : value);
    };
    folder = text("FAULT_FOLDER");
    count_file = text("FAULT_COUNT");
    at = std::atol(text("FAULT_AT").c_str());
    const std::string kind_word = text("FAULT_KIND"), reason_word = text("FAULT_REASON");
    kind = kind_word == "onwards" ? Kind::onwards : kind_word == "short" ? Kind::short_write : Kind::once;
    exception = reason_word == "std" || reason_word == "other" ? reason_word : "";
    reason = reason_word == "io" ? EIO : reason_word == "denied" ? EACCES : ENOSPC;
  }
  ~Plan() {
    if (!count_file.empty()) {
      const int file = static_cast<int>(open(count_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666));
      const std::string text = std::to_string(calls.load()) + "\n";
      if (file < 0 || write(file, text.data(), text.size()) < 0) {
        std::abort();
      }
      close(file);
    }
  }
};

Plan& plan() {
  static Plan the_plan;
  return the_plan;
}

[[gnu::constructor]] void begin() { (void)plan(); }

enum class Fate { goes_on, fails, half };

Fate fate_of_call(const char* path) {
  Plan& the = plan();
  if (the.folder.empty() || path == nullptr || std::strncmp(path, the.folder.c_str(), the.folder.size()) != 0) {
    return Fate::goes_on;
  }
  const long call = ++the.calls;
  if (the.at <= 0 || call < the.at || (call > the.at && the.kind == Kind::once)) {
    return Fate::goes_on;
  }
  return call == the.at && the.kind == Kind::short_write ? Fate::half : Fate::fails;
}

Fate fate_of_call(int descriptor) {
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) {
    return Fate::goes_on;
  }
  path[length] = '\0';
  return fate_of_call(path);
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <class Result>
Result failed(Result value) {
  if (plan().exception == "std") {
    throw std::runtime_error("a call of the system failed\033[31m");
  }
  if (plan().exception == "other") {
    throw plan().reason;
  }
  errno = plan().reason;
  return value;
}

bool changes_files(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)) != 0; }

int open_with(const char* name, const char* path, int flags, mode_t mode) {
  if (changes_files(flags) && fate_of_call(path) != Fate::goes_on) {
    return failed(-1);
  }
  return real<int(const char*, int, ...)>(name)(path, flags, mode);
}

}  // namespace

extern "C" {

#define OPENS(name)                                                         \
  int name(const char* path, int flags, ...) {                              \
    va_list words;                                                          \
    va_start(words, flags);                                                 \
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(words, mode_t) : 0; \
    va_end(words);                                                          \
    return open_with(#name, path, flags, mode);                             \
  }
OPENS(open)
OPENS(open64)

ssize_t write(int descriptor, const void* data, size_t bytes) {
  const Fate fate = fate_of_call(descriptor);
  if (fate == Fate::fails) {
    return failed<ssize_t>(-1);
  }
  const size_t share = fate == Fate::half ? bytes / 2 : bytes;
  return real<ssize_t(int, const void*, size_t)>("write")(descriptor, data, share);
}

// A function that returns `failure` if the call on `place` is to fail, and else what the system's own returns.
#define FAILS(result, name, parameters, arguments, place, failure)                                                    \
  result name parameters {                                                                                            \
    return fate_of_call(place) != Fate::goes_on ? failed<result>(failure) : real<result parameters>(#name) arguments; \
  }
#define WRITTEN(path, mode) (std::strpbrk(mode, "wa+") != nullptr ? (path) : nullptr)
FAILS(FILE*, fopen, (const char* path, const char* mode), (path, mode), WRITTEN(path, mode), nullptr)
FAILS(FILE*, fopen64, (const char* path, const char* mode), (path, mode), WRITTEN(path, mode), nullptr)
FAILS(ssize_t, writev, (int file, const iovec* parts, int count), (file, parts, count), file, -1)
FAILS(ssize_t, pwrite64, (int file, const void* data, size_t bytes, off64_t at), (file, data, bytes, at), file, -1)
FAILS(size_t, fwrite, (const void* data, size_t size, size_t count, FILE* file), (data, size, count, file),
      fileno(file), 0)
FAILS(int, fsync, (int file), (file), file, -1)
FAILS(int, ftruncate, (int file, off_t size), (file, size), file, -1)
FAILS(int, ftruncate64, (int file, off64_t size), (file, size), file, -1)
FAILS(int, rename, (const char* from, const char* to), (from, to), to, -1)
FAILS(int, mkdir, (const char* path, mode_t mode), (path, mode), path, -1)

int fclose(FILE* file) {
  const bool fails = fate_of_call(fileno(file)) != Fate::goes_on;
  const int result = real<int(FILE*)>("fclose")(file);
  return fails ? failed(EOF) : result;
}

int flock(int descriptor, int kind) {
  const char* locks = std::getenv("FAULT_LOCKS");
  if (locks != nullptr && std::strcmp(locks, "absent") == 0) {
    errno = ENOLCK;
    return -1;
  }
  return real<int(int, int)>("flock")(descriptor, kind);
}

}  // extern "C"
