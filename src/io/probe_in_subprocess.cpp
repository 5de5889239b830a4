#include "io/probe_in_subprocess.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace thawslide::io {

namespace {

using Work = std::function<bool(std::size_t)>;

[[noreturn]] void work_through(std::size_t first, std::size_t count, const Work& work, int to) {
  constexpr unsigned longest = 60;  // s, time limit
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  for (std::size_t k = first; k < count; ++k) {
    alarm(longest);
    char specified = 0;
    try {
      specified = work(k) ? 1 : 0;
    } catch (...) {  // NOLINT(bugprone-empty-catch): it is told as what cannot be done
    }
    if (write(to, &specified, 1) != 1) {
      _exit(1);
    }
  }
  _exit(0);
}

// Appends the results of a child process, which started with the next item.
void listen(int from, pid_t child, std::vector<bool>& specified) {
  char one = 0;
  for (ssize_t got = 1; got > 0 || (got < 0 && errno == EINTR);) {
    got = read(from, &one, 1);
    if (got == 1) {
      specified.push_back(one == 1);
    }
  }
  close(from);
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

std::vector<bool> probe_in_subprocess(std::size_t count, const Work& work) {
  std::vector<bool> specified;
  while (specified.size() < count) {
    int ends[2];
    if (pipe(ends) != 0) {
      break;
    }
    const pid_t child = fork();
    if (child == 0) {
      close(ends[0]);
      work_through(specified.size(), count, work, ends[1]);
    }
    close(ends[1]);
    if (child < 0) {
      close(ends[0]);
      break;
    }
    listen(ends[0], child, specified);
    if (specified.size() < count) {
      specified.push_back(false);  // the child ended during this item
    }
  }
  specified.resize(count, true);
  return specified;
}

}  // namespace thawslide::io
