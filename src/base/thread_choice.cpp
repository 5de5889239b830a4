#include "base/thread_choice.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace thawslide {

namespace {

constexpr double trial_seconds = 0.02;  // some time slices of the operating system
constexpr std::int64_t trial_steps = 2;
constexpr double first_pause = 0.1, longest_pause = 4;  // [s] between challenges
constexpr double worth_it = 1.05;                       // a challenger must be faster by as much, since trials scatter
constexpr double slowed_down = 0.7;                     // of the speed of the trial before: something has changed

}  // namespace

ThreadChoice::ThreadChoice(int most, double now)
    : most_(most), best_(most), threads_(most), trial_begin_(now), pause_(first_pause), next_challenge_(now) {
  THAWSLIDE_ASSERT(most >= 1, "{} threads", most);
}

int ThreadChoice::after_step(double now) {
  ++steps_;
  if (most_ > 1 && steps_ >= trial_steps && now - trial_begin_ >= trial_seconds) {
    end_trial(static_cast<double>(steps_) / (now - trial_begin_), now);
    trial_begin_ = now;
    steps_ = 0;
  }
  return threads_;
}

void ThreadChoice::end_trial(double speed, double now) {
  if (threads_ != best_) {
    const bool won = speed > worth_it * speed_of_best_;
    settle(won ? threads_ : best_, now, won ? first_pause : std::min(2 * pause_, longest_pause));
    speed_of_best_ = won ? speed : speed_of_best_;
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

void ThreadChoice::settle(int threads, double now, double pause) {
  threads_ = best_ = threads;
  pause_ = pause;
  next_challenge_ = now + pause;
}

}  // namespace thawslide
