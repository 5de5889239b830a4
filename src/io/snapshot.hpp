// Particle state as a VTKHDF file: PolyData with one vertex per particle. A separate group has the table of the base.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/state_numbers.hpp"
#include "mpm/particles.hpp"

namespace thawslide::io {

struct SnapshotField {
  std::string name, unit;
  std::size_t components;
  bool integer;
  std::vector<double> values;  // in particle order
};

struct Snapshot {
  double time;  // [s]
  std::int64_t step;
  std::vector<double> points;  // x y z of each particle [m]
  std::vector<SnapshotField> fields;
  NamedNumbers base;  // basal segments: one row each of position_m (x y z) and of the other columns; empty: none

  [[nodiscard]] std::size_t particles() const { return points.size() / 3; }
};

// Fields marked for snapshots, without values.
template <int Dim>
std::vector<SnapshotField> snapshot_fields(const mpm::Particles<Dim>& particles);

// These fields by id, with the local origin added, three components in 2D (z = 0), tensors as xx yy zz xy yz xz.
template <int Dim>
Snapshot make_snapshot(const mpm::Particles<Dim>& particles, const Vector<double, Dim>& origin, double time,
                       std::int64_t step);

// Bytes of the file; the same snapshot gives the same bytes.
std::vector<std::byte> snapshot_bytes(const Snapshot& snapshot);

// Size of one of the particles in the file, which has a few kilobytes in addition [bytes].
template <int Dim>
std::size_t snapshot_bytes_of_particle(const mpm::Particles<Dim>& particles);

// Memory indices of the particles in order of id.
template <int Dim>
std::vector<std::size_t> order_by_id(const mpm::Particles<Dim>& particles);

}  // namespace thawslide::io
