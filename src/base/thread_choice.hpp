// Number of threads of a run, chosen while it runs: fewer if more slow each other down. Results do not depend on it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/error.hpp"

namespace thawslide {

class ThreadChoice {
 public:
  // most: maximum number of threads, at least 1. now: reading of a monotonic clock [s].
  ThreadChoice(int most, double now)
      : most_(most), best_(most), threads_(most), challenger_(most), trial_begin_(now), next_challenge_(now) {
    THAWSLIDE_ASSERT(most >= 1, "{} threads", most);
  }

  // Returns the number of threads for the next step. Call after every step.
  int after_step(double now) {
    ++steps_;
    const double seconds = now - trial_begin_;
    if (most_ > 1 && steps_ >= trial_steps && seconds >= trial_seconds) {
      end_trial({static_cast<double>(steps_), seconds}, now);
      trial_begin_ = now;
      steps_ = 0;
    }
    return threads_;
  }
  [[nodiscard]] int threads() const { return threads_; }

 private:
  static constexpr double trial_seconds = 0.02;  // several time slices of the operating system
  static constexpr std::int64_t trial_steps = 2;
  static constexpr double first_pause = 0.1, longest_pause = 4;   // [s] between challenges, if steps are short
  static constexpr double first_trials = 5, trials_between = 50;  // minimum pause in lengths of a trial
  static constexpr int most_rounds = 3;  // single trials on a busy machine vary by half; a challenger must win in total
  static constexpr double hopeless = 0.8, worth_it = 1.05;  // relative to the speed of the best
  static constexpr double slowed_down = 0.7;                // relative to the usual speed: conditions have changed
  static constexpr int few_slow_trials = 3;
  static constexpr double memory = 0.8;  // weight of the usual speed per trial

  // Totals of trials with a number of threads.
  struct Tally {
    double steps = 0, seconds = 0;

    void add(const Tally& more) {
      steps += more.steps;
      seconds += more.seconds;
    }
    [[nodiscard]] double speed() const { return steps / seconds; }
  };

  void end_trial(const Tally& trial, double now) {
    if (is_cold_) {  // first access to memory
      is_cold_ = false;
    } else if (challenger_ == best_) {
      watch_best(trial, now);
    } else {
      continue_challenge(trial, now);
    }
  }

  void watch_best(const Tally& trial, double now) {
    const double speed = trial.speed();
    if (speed < slowed_down * usual_speed_) {
      ++slow_trials_;
    } else {
      slow_trials_ = 0;
      usual_speed_ = usual_speed_ > 0 ? memory * usual_speed_ + (1 - memory) * speed : speed;
    }
    if (slow_trials_ >= few_slow_trials || now >= next_challenge_) {
      slow_trials_ = rounds_ = 0;
      of_best_ = trial;
      of_challenger_ = {};
      threads_ = challenger_ = next_challenger();
    }
  }

  // Best and challenger alternate.
  void continue_challenge(const Tally& trial, double now) {
    if (threads_ == best_) {
      of_best_.add(trial);
      threads_ = challenger_;
      return;
    }
    of_challenger_.add(trial);
    const bool loses = of_challenger_.speed() < hopeless * of_best_.speed();
    if (++rounds_ < most_rounds && !loses) {
      threads_ = best_;
      return;
    }
    const bool won = of_challenger_.speed() > worth_it * of_best_.speed();
    usual_speed_ = (won ? of_challenger_ : of_best_).speed();
    threads_ = best_ = challenger_ = won ? challenger_ : best_;
    pause_ = won ? first_pause : std::min(2 * pause_, longest_pause);
    next_challenge_ = now + std::max(pause_, (won ? first_trials : trials_between) * trial.seconds);
  }

  // One thread fewer or more, half or twice as many, in turn.
  int next_challenger() {
    const int challengers[] = {best_ - 1, best_ + 1, best_ / 2, 2 * best_};
    int challenger = best_;
    while (challenger == best_ || challenger < 1 || challenger > most_) {
      challenger = challengers[next_challenger_++ % 4];
    }
    return challenger;
  }

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
  double pause_ = first_pause, next_challenge_;
};

}  // namespace thawslide
