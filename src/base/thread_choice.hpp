// Number of threads of a run, optimized while it runs. Fewer than the maximum are used if more slow each other down,
// for example because another process occupies a core or a case is too small. Results are independent of the number.
#pragma once

#include <cstdint>

namespace thawslide {

class ThreadChoice {
 public:
  // most: maximum number of threads, at least 1. now: reading of a monotonic clock [s].
  ThreadChoice(int most, double now);

  // Returns the number of threads for the next step. Call after every step.
  int after_step(double now);
  [[nodiscard]] int threads() const { return threads_; }

 private:
  // Totals of trials with a number of threads.
  struct Tally {
    double steps = 0, seconds = 0;

    void add(double more_steps, double more_seconds) {
      steps += more_steps;
      seconds += more_seconds;
    }
    [[nodiscard]] double speed() const { return steps / seconds; }
  };

  void end_trial(double steps, double seconds, double now);
  void watch_best(double steps, double seconds, double now);
  void continue_challenge(double steps, double seconds, double now);
  [[nodiscard]] int next_challenger();

  int most_;
  int best_;        // so far
  int threads_;     // current: the best or its challenger
  int challenger_;  // equal to the best if there is none
  int next_challenger_ = 0;
  Tally of_best_, of_challenger_;  // in this challenge
  double usual_speed_ = 0;         // of the best [steps/s], with exponentially decreasing weights
  int slow_trials_ = 0;            // of the best, consecutive
  double trial_begin_;
  std::int64_t steps_ = 0;  // of this trial
  bool is_cold_ = true;     // the first trial does not count
  int rounds_ = 0;          // of this challenge
  double pause_, next_challenge_;
};

}  // namespace thawslide
