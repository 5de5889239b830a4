// The executor on the CPU, and lists and sums on it.
#include "exec/cpu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "exec/keyed_parts.hpp"
#include "exec/ordered_sum.hpp"
#include "exec/selection.hpp"

namespace thawslide::exec {
namespace {

// Some of few keys, which differ in their highest and lowest bits.
std::uint64_t key_of(std::size_t place) { return (place * place % 7) << 61 | (place % 3) << 32 | place % 2; }

TEST(Cpu, SortsByAllBitsAndKeepsTheOrderOfEqualKeys) {
  for (const std::size_t count : {0u, 1u, 500u}) {
    std::vector<std::uint64_t> keys(count), sorted_keys(count);
    std::vector<std::uint32_t> values(count), sorted(count);
    for (std::size_t k = 0; k < count; ++k) {
      keys[k] = key_of(k);
      values[k] = static_cast<std::uint32_t>(k);
    }
    Cpu().sort(keys.data(), values.data(), sorted_keys.data(), sorted.data(), count);
    for (std::size_t k = 0; k < count; ++k) {
      ASSERT_EQ(sorted_keys[k], key_of(sorted[k]));
      if (k > 0) {
        ASSERT_LE(sorted_keys[k - 1], sorted_keys[k]);
        ASSERT_TRUE(sorted_keys[k - 1] < sorted_keys[k] || sorted[k - 1] < sorted[k]) << "place " << k;
      }
    }
  }
}

// A sum that depends on its order.
struct Word {
  std::uint64_t letters = 1;
  Word& operator+=(const Word& part) {
    letters = 31 * letters + part.letters;
    return *this;
  }
};

struct KeyOf {
  std::uint64_t operator()(std::size_t place) const { return key_of(place); }
};

TEST(KeyedParts, AreAddedInTheOrderOfTheirPlaces) {
  constexpr std::size_t places = 5000;
  Cpu cpu;
  KeyedParts<Word, Cpu> parts(cpu);
  parts.list(places, KeyOf{});
  for (std::size_t k = 0; k < places; ++k) {
    parts.parts()[k] = {k};
  }
  parts.sum();
  Array<std::int32_t, Cpu> index(cpu);
  parts.places().index(index);
  const std::vector<std::uint64_t> keys = parts.keys().get();
  std::vector<Word> expected(keys.size());
  for (std::size_t k = 0; k < places; ++k) {
    const auto of_key = static_cast<std::size_t>(index.data()[k]);
    ASSERT_EQ(keys.at(of_key), key_of(k));
    expected[of_key] += {k};
  }
  for (std::size_t c = 0; c < keys.size(); ++c) {
    EXPECT_EQ(parts.sums()[c].letters, expected[c].letters);
  }
}

TEST(OrderedSum, AddsRunsAndThenTheirSums) {
  constexpr std::size_t count = 5 * parts_of_a_run + 3;
  Cpu cpu;
  OrderedSum<Word, Cpu> sum(cpu);
  Word expected{};
  Word* parts = sum.parts(count);
  for (std::size_t run = 0; run < runs_of(count); ++run) {
    Word of_run{};
    for (std::size_t k = run * parts_of_a_run; k < std::min(count, (run + 1) * parts_of_a_run); ++k) {
      parts[k] = {k};
      of_run += parts[k];
    }
    expected += of_run;
  }
  EXPECT_EQ(sum.total().letters, expected.letters);
  static_cast<void>(sum.parts(0));
  EXPECT_EQ(sum.total().letters, Word{}.letters);
}

TEST(Selection, KeepsMarkedItemsInOrderAndAGrownArrayItsContents) {
  constexpr std::size_t count = 1000;
  Cpu cpu;
  Array<std::size_t, Cpu> items(cpu), kept(cpu);
  for (std::size_t k = 0; k < count; ++k) {
    items.grow(k + 1);
    items.data()[k] = k;
  }
  Selection<Cpu> selection(cpu);
  std::uint32_t* marks = selection.marks(count);
  std::vector<std::size_t> expected;
  for (std::size_t k = 0; k < count; ++k) {
    marks[k] = key_of(k) % 2 == 0 && k % 3 != 0 ? 1 : 0;
    if (marks[k] != 0) {
      expected.push_back(k);
    }
  }
  selection.keep(selection.count(), items, kept);
  EXPECT_EQ(kept.get(), expected);
  static_cast<void>(selection.marks(0));
  EXPECT_EQ(selection.count(), 0u);
}

}  // namespace
}  // namespace thawslide::exec
