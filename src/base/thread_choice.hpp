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
  // What trials on some number of threads have brought.
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
  void go_on_with_challenge(double steps, double seconds, double now);
  [[nodiscard]] int next_challenger();

  int most_;
  int best_;        // so far
  int threads_;     // in force: the best or its challenger
  int challenger_;  // the best where there is none
  int next_challenger_ = 0;
  Tally of_best_, of_challenger_;  // in this challenge
  double usual_speed_ = 0;         // of the best [steps/s], its last trials counting most
  int slow_trials_ = 0;            // of the best, one after another
  double trial_begin_;
  std::int64_t steps_ = 0;  // of this trial
  bool is_cold_ = true;     // the first trial does not count
  int rounds_ = 0;          // of this challenge
  double pause_, next_challenge_;
};

}  // namespace thawslide
