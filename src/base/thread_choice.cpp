#include "base/thread_choice.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace thawslide {

namespace {

constexpr double trial_seconds = 0.02;  // some time slices of the operating system
constexpr std::int64_t trial_steps = 2;
constexpr double first_pause = 0.1, longest_pause = 4;   // [s] between challenges, where steps are short
constexpr double first_trials = 5, trials_between = 50;  // at least as many times a trial's length, where they are long
constexpr double worth_it = 1.05;                        // a challenger must be faster by as much, since trials scatter
constexpr double slowed_down = 0.7;                      // of the speed of the trial before: something has changed

}  // namespace

ThreadChoice::ThreadChoice(int most, double now)
    : most_(most), best_(most), threads_(most), trial_begin_(now), pause_(first_pause), next_challenge_(now) {
  THAWSLIDE_ASSERT(most >= 1, "{} threads", most);
}

int ThreadChoice::after_step(double now) {
  ++steps_;
  const double length = now - trial_begin_;
  if (most_ > 1 && steps_ >= trial_steps && length >= trial_seconds) {
    end_trial(static_cast<double>(steps_) / length, length, now);
    trial_begin_ = now;
    steps_ = 0;
  }
  return threads_;
}

void ThreadChoice::end_trial(double speed, double length, double now) {
  if (is_cold_) {  // memory was touched for the first time
    is_cold_ = false;
    return;
  }
  if (threads_ != best_) {
    const bool won = speed > worth_it * speed_of_best_;
    threads_ = best_ = won ? threads_ : best_;
    speed_of_best_ = won ? speed : speed_of_best_;
    pause_ = won ? first_pause : std::min(2 * pause_, longest_pause);
    next_challenge_ = now + std::max(pause_, (won ? first_trials : trials_between) * length);
    return;
  }
  const bool slower = speed < slowed_down * speed_of_best_;
  speed_of_best_ = speed;
  if (slower || now >= next_challenge_) {
    challenge();
  }
}

// One thread fewer or more, half or twice as many, in turn.
void ThreadChoice::challenge() {
  const int challengers[] = {best_ - 1, best_ + 1, best_ / 2, 2 * best_};
  for (int k = 0; k < 4 && threads_ == best_; ++k) {
    const int challenger = challengers[next_challenger_++ % 4];
    if (challenger >= 1 && challenger <= most_) {
      threads_ = challenger;
    }
  }
}

}  // namespace thawslide
