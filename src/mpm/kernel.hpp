// Kernels: pure functions of one particle that make up the stages of a step, with declarations of their data. A kernel
// is an object with
//   Reads, Adds   lists of the nodal records that it reads and that it adds to or reduces by minimum (mpm/nodes.hpp)
//   Account       its sum over all particles
//   operator()(particles, at, seen, added, totals)
// `at` is the index of one particle, or a batch of them (mpm/simd_batch.hpp): particles.FIELD.load(at) loads its
// numbers, seen.read<Record, Count>() interpolates nodal records, and contributions to nodes are stored in
// added.of<Record>(). A kernel has no loops, batches or patches; mpm/particle_pass.hpp runs it over all or some tiles.
#pragma once

#include <cstddef>
#include <type_traits>

#include "base/portability.hpp"

namespace thawslide::mpm {

// Shape functions of a record: those of momentum, which the run selects, or the linear ones.
struct MomentumFunctions {};
struct LinearFunctions {};
// Shape functions of momentum with S (x_i - x_p)/D in place of their gradients (APIC).
struct AffineFunctions {};

// For records to which no kernel adds a flux.
inline constexpr int no_flux = -1;

// For kernels without sums over particles.
struct NoTotals {
  THAWSLIDE_HD NoTotals& operator+=(const NoTotals& /*part*/) { return *this; }
};

// Section width for kernels if it is uniform (mpm/section_width.hpp).
struct EvenWidth {
  static constexpr bool varies = false;
};

template <class... Names>
struct RecordList {};

template <class Name, class List>
inline constexpr bool contains = false;
template <class Name, class... Names>
inline constexpr bool contains<Name, RecordList<Names...>> = (std::is_same_v<Name, Names> || ...);

// A name can be an alias of its owner's record.
template <class Name>
struct OwnerOf {
  using Type = Name;
};
template <class Name>
requires requires { typename Name::Owner; }
struct OwnerOf<Name> {
  using Type = typename Name::Owner;
};

// Components of a record: `count` of them, from number `from` on.
struct RecordPart {
  std::size_t from, count;
};
// Components that particles add to under a name; all of the record by default.
template <class Name, int Dim>
inline constexpr RecordPart part_of{0, static_cast<std::size_t>(Name::template size<Dim>)};
template <class Name, int Dim>
requires requires { Name::template part<Dim>; }
inline constexpr RecordPart part_of<Name, Dim> = Name::template part<Dim>;

// True if the components of a name are reduced by minimum instead of sum.
template <class Name>
concept IsMinReduced = requires {
  requires Name::min_reduced;
};

// True if two names, or all names of a list, add to different components. Otherwise, the order of additions would
// depend on batch boundaries.
template <class First, class Second, int Dim>
inline constexpr bool are_apart =
    std::is_same_v<First, Second> || !std::is_same_v<typename OwnerOf<First>::Type, typename OwnerOf<Second>::Type> ||
    part_of<First, Dim>.from + part_of<First, Dim>.count <= part_of<Second, Dim>.from ||
    part_of<Second, Dim>.from + part_of<Second, Dim>.count <= part_of<First, Dim>.from;
template <class Name, class List, int Dim>
inline constexpr bool is_apart_from = false;
template <class Name, class... Names, int Dim>
inline constexpr bool is_apart_from<Name, RecordList<Names...>, Dim> = (are_apart<Name, Names, Dim> && ...);
template <class List, int Dim>
inline constexpr bool all_apart = false;
template <class... Names, int Dim>
inline constexpr bool all_apart<RecordList<Names...>, Dim> = (is_apart_from<Names, RecordList<Names...>, Dim> && ...);

// True if all names of a list belong to one record.
template <class List>
inline constexpr bool one_record = true;
template <class Name, class... Names>
inline constexpr bool one_record<RecordList<Name, Names...>> =
    (std::is_same_v<typename OwnerOf<Name>::Type, typename OwnerOf<Names>::Type> && ...);

// True if two lists have no record in common under any name.
template <class First, class Second>
inline constexpr bool are_disjoint = false;
template <class... Names, class... Others>
inline constexpr bool are_disjoint<RecordList<Names...>, RecordList<Others...>> =
    (!contains<typename OwnerOf<Names>::Type, RecordList<typename OwnerOf<Others>::Type...>> && ...);

// Union of the records of several lists.
template <class List, class... Lists>
struct Joined {
  using Type = List;
};
template <class... Names, class Name, class... Others, class... Lists>
struct Joined<RecordList<Names...>, RecordList<Name, Others...>, Lists...>
    : Joined<std::conditional_t<contains<Name, RecordList<Names...>>, RecordList<Names...>, RecordList<Names..., Name>>,
             RecordList<Others...>, Lists...> {};
template <class... Names, class... Lists>
struct Joined<RecordList<Names...>, RecordList<>, Lists...> : Joined<RecordList<Names...>, Lists...> {};
template <class... Lists>
using AllOf = typename Joined<RecordList<>, Lists...>::Type;

// Components of a record.
template <class Name, int Dim>
inline constexpr int components_of = Name::template size<Dim>;

// One item per record of a list, accessed by the record's name.
template <class Name, class Item>
struct Named {
  Item item;
};
template <class... Items>
struct ByName : Items... {
  template <class Name, class Item>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Item& pick(Named<Name, Item>& named) {
    return named.item;
  }
  template <class Name, class Item>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static const Item& pick(const Named<Name, Item>& named) {
    return named.item;
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto& of() {
    return pick<Name>(*this);
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    return pick<Name>(*this);
  }
};

}  // namespace thawslide::mpm
