// Items of a list that are marked, in order.
#pragma once

#include "exec/array.hpp"
#include "exec/key_lists.hpp"

namespace thawslide::exec {

// Copies the marked items.
template <class Item>
struct KeepMarked {
  const std::uint32_t *marks, *before;
  const Item* items;
  Item* kept;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    if (marks[k] != 0) {
      kept[before[k]] = items[k];
    }
  }
};

template <class Executor>
class Selection {
 public:
  explicit Selection(Executor& executor) : executor_(executor) {}

  // Memory for the marks of `count` items, to be written before the other functions are called: 1 or 0, or any number
  // of places for results of an item.
  [[nodiscard]] std::uint32_t* marks(std::size_t count) {
    marks_.resize(count);
    return marks_.data();
  }
  // Sum of all marks.
  [[nodiscard]] std::size_t count() {
    const std::size_t items = marks_.size();
    before_.resize(items);
    executor_.sum_before(marks_.data(), before_.data(), items);
    return items > 0 ? before_.get(items - 1) + marks_.get(items - 1) : 0;
  }
  // Sum of the marks before each item, by the last call of count().
  [[nodiscard]] const std::uint32_t* before() const { return before_.data(); }

  // Copies the marked items, `count` by the last call of count(), to another array.
  template <class Item>
  void keep(std::size_t count, const Array<Item, Executor>& items, Array<Item, Executor>& kept) {
    kept.resize(count);
    executor_.for_each(marks_.size(), KeepMarked<Item>{marks_.data(), before_.data(), items.data(), kept.data()});
  }

 private:
  Executor& executor_;
  Array<std::uint32_t, Executor> marks_{executor_}, before_{executor_};
};

}  // namespace thawslide::exec
