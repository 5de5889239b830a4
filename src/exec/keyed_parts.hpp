// Sums of parts by key: a list of places, each with a key and a part. Parts of one key are added in the order of
// places.
#pragma once

#include "exec/key_lists.hpp"

namespace thawslide::exec {

template <class KeyOf>
struct ListKeys {
  KeyOf key_of;
  std::uint64_t* keys;
  std::uint32_t* places;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    keys[k] = key_of(k);
    places[k] = static_cast<std::uint32_t>(k);
  }
};

// Index of the key of each place. places: sorted by key.
struct IndexOfPlace {
  const std::uint32_t *places, *is_first, *number;
  std::int32_t* index;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    index[places[k]] = static_cast<std::int32_t>(number[k] + is_first[k]) - 1;
  }
};

// One thread per key.
template <class Part>
struct SumParts {
  const std::uint32_t *first, *places;  // first: of a key, in `places`
  std::size_t keys, all_places;
  const Part* parts;
  Part* sums;

  THAWSLIDE_HD void operator()(std::size_t key) const {
    const std::size_t last = key + 1 < keys ? first[key + 1] : all_places;
    Part sum;
    for (std::size_t k = first[key]; k < last; ++k) {
      sum += parts[places[k]];
    }
    sums[key] = sum;
  }
};

// Places sorted by their keys.
template <class Executor>
class KeyedPlaces {
 public:
  explicit KeyedPlaces(Executor& executor) : executor_(executor) {}

  // Lists the keys key_of(place) of places 0 .. count-1.
  template <class KeyOf>
  void list(std::size_t count, const KeyOf& key_of) {
    for (Array<std::uint64_t, Executor>* keys : {&listed_keys_, &sorted_keys_}) {
      keys->resize(count);
    }
    for (Array<std::uint32_t, Executor>* places : {&listed_, &sorted_}) {
      places->resize(count);
    }
    executor_.for_each(count, ListKeys<KeyOf>{key_of, listed_keys_.data(), listed_.data()});
    executor_.sort(listed_keys_.data(), listed_.data(), sorted_keys_.data(), sorted_.data(), count);
    unique_.find(sorted_keys_, 0, keys_, &first_);
  }
  // Number of the key of each place.
  void index(Array<std::int32_t, Executor>& index) {
    index.resize(sorted_.size());
    executor_.for_each(index.size(), IndexOfPlace{sorted_.data(), unique_.is_first(), unique_.number(), index.data()});
  }

  [[nodiscard]] std::size_t size() const { return sorted_.size(); }
  [[nodiscard]] const Array<std::uint64_t, Executor>& keys() const { return keys_; }  // ascending
  [[nodiscard]] const std::uint32_t* sorted() const { return sorted_.data(); }
  [[nodiscard]] const std::uint32_t* first() const { return first_.data(); }  // of a key, in sorted()

 private:
  Executor& executor_;
  UniqueKeys<Executor> unique_{executor_};
  Array<std::uint64_t, Executor> listed_keys_{executor_}, sorted_keys_{executor_}, keys_{executor_};
  Array<std::uint32_t, Executor> listed_{executor_}, sorted_{executor_}, first_{executor_};
};

template <class Part, class Executor>
class KeyedParts {
 public:
  explicit KeyedParts(Executor& executor) : executor_(executor) {}

  template <class KeyOf>
  void list(std::size_t count, const KeyOf& key_of) {
    places_.list(count, key_of);
    parts_.resize(count);
    sums_.resize(keys().size());
  }
  // Call after all parts have been written.
  void sum() {
    executor_.for_each(sums_.size(), SumParts<Part>{places_.first(), places_.sorted(), sums_.size(), parts_.size(),
                                                    parts_.data(), sums_.data()});
  }

  [[nodiscard]] KeyedPlaces<Executor>& places() { return places_; }
  [[nodiscard]] const Array<std::uint64_t, Executor>& keys() const { return places_.keys(); }
  [[nodiscard]] std::size_t size() const { return parts_.size(); }
  [[nodiscard]] Part* parts() { return parts_.data(); }            // by place
  [[nodiscard]] const Part* sums() const { return sums_.data(); }  // by key

 private:
  Executor& executor_;
  KeyedPlaces<Executor> places_{executor_};
  Array<Part, Executor> parts_{executor_}, sums_{executor_};
};

}  // namespace thawslide::exec
