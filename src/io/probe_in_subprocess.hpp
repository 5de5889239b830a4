// Trial of library calls that may crash on damaged files, in a separate process.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace thawslide::io {

// Calls work(k) for k = 0 .. count-1 in a separate process. Returns the results; false if the call threw, ended its
// process or took more than a minute, after which another process continues with the next item. If no process can be
// created, all are true without a trial.
[[nodiscard]] std::vector<bool> probe_in_subprocess(std::size_t count, const std::function<bool(std::size_t)>& work);

}  // namespace thawslide::io
