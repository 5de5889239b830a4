// How many threads a run works on, found while it goes on: as many as it may use, or fewer while these only hold one
// another up, as when another process sits on one of their cores or when a case is too small. Results do not depend on
// the number.
#pragma once

#include <cstdint>

namespace thawslide {

class ThreadChoice {
 public:
  // most: threads the run may use, at least 1. now: the clock's reading [s], of any clock that never turns back.
  ThreadChoice(int most, double now);

  // The threads for the next step; to be asked after every step.
  int after_step(double now);
  [[nodiscard]] int threads() const { return threads_; }

 private:
  void end_trial(double speed, double length, double now);
  void challenge();

  int most_;
  int best_;     // of the trials so far
  int threads_;  // in force: the best or its challenger
  int next_challenger_ = 0;
  double speed_of_best_ = 0;  // [steps/s] in its last trial
  double trial_begin_;
  std::int64_t steps_ = 0;  // of this trial
  bool is_cold_ = true;     // the first trial does not count
  double pause_, next_challenge_;
};

}  // namespace thawslide
