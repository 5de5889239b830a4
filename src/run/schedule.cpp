#include "run/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace thawslide::run {

Schedule::Schedule(double interval, double begin, double last_step, double end, double early)
    : interval_(interval), end_(end), early_(early), next_(interval > 0.0 ? std::min(interval, end) : end) {
  pass(begin, last_step);
}

void Schedule::pass(double time, double step) {
  if (interval_ <= 0.0) {
    return;
  }
  // Computes the first multiple after the time directly, because counting takes too long for tiny intervals. Rounding
  // of the quotient may make the floor too small by up to two.
  const double beyond = time + early_ * step;
  count_ = std::max(count_, std::floor(beyond / interval_));
  for (int k = 0; k < 2 && count_ * interval_ <= beyond; ++k) {
    ++count_;
  }
  next_ = std::min(count_ * interval_, end_);
}

bool Schedule::reached(double time, double step) {
  if (time < next_ - (next_ < end_ ? early_ : 0.5) * step) {
    return false;
  }
  pass(time, step);
  return true;
}

bool has_reached_end(double time, double last_step, double end) { return time >= end - 0.5 * last_step; }

Schedule history_schedule(const config::Time& times, double time, double last_step) {
  constexpr double round_off = 1e-6;  // of a step
  return {times.history_interval, time, last_step, times.end,
          times.stepping == config::Stepping::adaptive ? round_off : 0.5};
}

Schedule snapshot_schedule(const config::Time& times, double time, double last_step) {
  return {times.output_interval, time, last_step, times.end};
}

}  // namespace thawslide::run
