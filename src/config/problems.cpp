#include "config/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {

std::string Location::text() const {
  if (command_line || line == 0) {
    return source;
  }
  return fmt::format("{}:{}:{}", source, line, column);
}

void Problems::add(Location location, std::string message) {
  found_.push_back({std::move(location), std::move(message)});
}

void Problems::raise_if_any() const {
  if (found_.empty()) {
    return;
  }
  std::vector<Problem> sorted = found_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Problem& a, const Problem& b) {
    return a.location.command_line != b.location.command_line ? b.location.command_line
           : a.location.command_line                          ? false
                                     : std::tie(a.location.source, a.location.line, a.location.column) <
                                           std::tie(b.location.source, b.location.line, b.location.column);
  });
  std::string text;
  for (const Problem& each : sorted) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", each.location.text(), each.message);
  }
  throw UserError(text);
}

namespace {

char plain_letter(char letter) {
  if (letter == '-') {
    return '_';
  }
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

// Edit distance (insert, delete, replace, swap adjacent letters); ignores letter case, and '-' against '_'.
std::size_t edit_distance(const std::string& first, const std::string& second) {
  const std::size_t columns = second.size() + 1;
  std::vector<std::size_t> distance((first.size() + 1) * columns);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return distance[i * columns + j]; };
  for (std::size_t i = 0; i <= first.size(); ++i) {
    for (std::size_t j = 0; j <= second.size(); ++j) {
      if (i == 0 || j == 0) {
        at(i, j) = i + j;
        continue;
      }
      const char a = plain_letter(first[i - 1]);
      const char b = plain_letter(second[j - 1]);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (a == b ? 0U : 1U)});
      if (i > 1 && j > 1 && a == plain_letter(second[j - 2]) && b == plain_letter(first[i - 2])) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return distance.back();
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, std::min<std::size_t>(word.size() / 2, word.size() / 3 + 1)) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const std::string& otherwise) {
  const std::string best = nearest(word, candidates);
  return best.empty() ? otherwise : fmt::format("; did you mean '{}'?", best);
}

std::string comma_list(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

}  // namespace thawslide::config
