// Work of a library that may crash on damaged files, tried in a process of its own before it is done here.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace thawslide::io {

// Calls work(k) for k = 0 .. count-1 in a process of its own. Returns for which it returned true: not where it threw,
// ended its process or took more than a minute; another process then goes on behind it. Where the system gives no
// process, true without a try.
[[nodiscard]] std::vector<bool> probe_in_subprocess(std::size_t count, const std::function<bool(std::size_t)>& work);

}  // namespace thawslide::io
