#include "base/thread_choice.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace thawslide {

namespace {

constexpr double trial_seconds = 0.02;  // several time slices of the operating system
constexpr std::int64_t trial_steps = 2;
constexpr double first_pause = 0.1, longest_pause = 4;   // [s] between challenges, if steps are short
constexpr double first_trials = 5, trials_between = 50;  // minimum pause in lengths of a trial, if steps are long
constexpr int most_rounds = 3;  // single trials on a busy machine vary by half; a challenger must win in total
constexpr double hopeless = 0.8, worth_it = 1.05;  // relative to the speed of the best
constexpr double slowed_down = 0.7;                // relative to the usual speed: conditions have changed
constexpr int few_slow_trials = 3;
constexpr double memory = 0.8;  // weight of the usual speed per trial

}  // namespace

ThreadChoice::ThreadChoice(int most, double now)
    : most_(most),
      best_(most),
      threads_(most),
      challenger_(most),
      trial_begin_(now),
      pause_(first_pause),
      next_challenge_(now) {
  THAWSLIDE_ASSERT(most >= 1, "{} threads", most);
}

int ThreadChoice::after_step(double now) {
  ++steps_;
  const double seconds = now - trial_begin_;
  if (most_ > 1 && steps_ >= trial_steps && seconds >= trial_seconds) {
    end_trial(static_cast<double>(steps_), seconds, now);
    trial_begin_ = now;
    steps_ = 0;
  }
  return threads_;
}

void ThreadChoice::end_trial(double steps, double seconds, double now) {
  if (is_cold_) {  // first access to memory
    is_cold_ = false;
  } else if (challenger_ == best_) {
    watch_best(steps, seconds, now);
  } else {
    continue_challenge(steps, seconds, now);
  }
}

void ThreadChoice::watch_best(double steps, double seconds, double now) {
  const double speed = steps / seconds;
  if (speed < slowed_down * usual_speed_) {
    ++slow_trials_;
  } else {
    slow_trials_ = 0;
    usual_speed_ = usual_speed_ > 0 ? memory * usual_speed_ + (1 - memory) * speed : speed;
  }
  if (slow_trials_ >= few_slow_trials || now >= next_challenge_) {
    slow_trials_ = rounds_ = 0;
    of_best_ = of_challenger_ = {};
    of_best_.add(steps, seconds);
    threads_ = challenger_ = next_challenger();
  }
}

// Best and challenger alternate.
void ThreadChoice::continue_challenge(double steps, double seconds, double now) {
  if (threads_ == best_) {
    of_best_.add(steps, seconds);
    threads_ = challenger_;
    return;
  }
  of_challenger_.add(steps, seconds);
  const bool loses = of_challenger_.speed() < hopeless * of_best_.speed();
  if (++rounds_ < most_rounds && !loses) {
    threads_ = best_;
    return;
  }
  const bool won = of_challenger_.speed() > worth_it * of_best_.speed();
  usual_speed_ = (won ? of_challenger_ : of_best_).speed();
  threads_ = best_ = challenger_ = won ? challenger_ : best_;
  pause_ = won ? first_pause : std::min(2 * pause_, longest_pause);
  next_challenge_ = now + std::max(pause_, (won ? first_trials : trials_between) * seconds);
}

// One thread fewer or more, half or twice as many, in turn.
int ThreadChoice::next_challenger() {
  const int challengers[] = {best_ - 1, best_ + 1, best_ / 2, 2 * best_};
  int challenger = best_;
  while (challenger == best_ || challenger < 1 || challenger > most_) {
    challenger = challengers[next_challenger_++ % 4];
  }
  return challenger;
}

}  // namespace thawslide
