#include "io/snapshot.hpp"

#include <algorithm>
#include <numeric>

#include "io/hdf5_file.hpp"

namespace thawslide::io {

namespace {

// Number of components in the file: three for vectors, six for tensors.
std::size_t written_components(mpm::FieldShape shape) {
  return shape == mpm::FieldShape::scalar ? 1 : shape == mpm::FieldShape::vector ? 3 : 6;
}

// Group "basal_segments": one dataset per column, whose name ends with the unit.
void write_base(hid_t file, const NamedNumbers& base) {
  if (base.empty()) {
    return;
  }
  const hdf5::Handle group = hdf5::make_group(file, "basal_segments");
  const std::size_t segments = base.at("position_m").size() / 3;
  for (const auto& [name, numbers] : base) {
    const hdf5::Shape shape = numbers.size() == segments ? hdf5::Shape{segments} : hdf5::Shape{segments, 3};
    hdf5::write_dataset(group, name, shape, numbers.data());
  }
}

}  // namespace

template <int Dim>
std::vector<std::size_t> order_by_id(const mpm::Particles<Dim>& particles) {
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return particles.id(a) < particles.id(b); });
  return order;
}

template <int Dim>
std::vector<SnapshotField> snapshot_fields(const mpm::Particles<Dim>& particles) {
  std::vector<SnapshotField> fields;
  for (const mpm::FieldBase* field : particles.fields.all()) {
    if (field->is_in_snapshots()) {
      const mpm::FieldInfo& info = field->info();
      fields.push_back({info.name, info.unit, written_components(info.shape), field->is_integer(), {}});
    }
  }
  return fields;
}

template <int Dim>
Snapshot make_snapshot(const mpm::Particles<Dim>& particles, const Vector<double, Dim>& origin, double time,
                       std::int64_t step) {
  const std::vector<std::size_t> order = order_by_id(particles);
  Snapshot snapshot{time, step, {}, {}, {}};
  snapshot.points.reserve(3 * order.size());
  for (const std::size_t p : order) {
    for (int a = 0; a < 3; ++a) {
      snapshot.points.push_back(a < Dim ? static_cast<double>(particles.position(p, a)) + origin[std::min(a, Dim - 1)]
                                        : 0.0);
    }
  }
  snapshot.fields = snapshot_fields(particles);
  auto next = snapshot.fields.begin();
  for (const mpm::FieldBase* field : particles.fields.all()) {
    if (field->is_in_snapshots()) {
      field->append_values(order, next->components, next->values);
      ++next;
    }
  }
  return snapshot;
}

std::vector<std::byte> snapshot_bytes(const Snapshot& snapshot) {
  const std::size_t count = snapshot.particles();
  std::size_t numbers = (3 + 2) * count;  // coordinates, and two numbers per vertex
  for (const SnapshotField& field : snapshot.fields) {
    numbers += field.components * count;
  }
  const hdf5::MemoryFile file(numbers * sizeof(double));
  const hdf5::Handle root = hdf5::make_vtk_root(file.root());
  hdf5::write_attribute(root, "time", snapshot.time);
  hdf5::write_attribute(root, "step", snapshot.step);
  const auto points = static_cast<std::int64_t>(count);
  hdf5::write_dataset(root, "NumberOfPoints", {1}, &points);
  hdf5::write_dataset(root, "Points", {count, 3}, snapshot.points.data());
  std::vector<std::int64_t> ascending(count + 1);
  std::iota(ascending.begin(), ascending.end(), std::int64_t{0});
  for (const char* kind : hdf5::cell_kinds) {
    const std::size_t cells = kind == hdf5::cell_kinds[0] ? count : 0;
    const auto number = static_cast<std::int64_t>(cells);
    const hdf5::Handle group = hdf5::make_group(root, kind);
    hdf5::write_dataset(group, "NumberOfCells", {1}, &number);
    hdf5::write_dataset(group, "NumberOfConnectivityIds", {1}, &number);
    hdf5::write_dataset(group, "Offsets", {cells + 1}, ascending.data());
    hdf5::write_dataset(group, "Connectivity", {cells}, ascending.data());
  }
  const hdf5::Handle data = hdf5::make_group(root, "PointData");
  for (const SnapshotField& field : snapshot.fields) {
    const hdf5::Shape shape = field.components == 1 ? hdf5::Shape{count} : hdf5::Shape{count, field.components};
    if (field.integer) {
      const std::vector<std::int64_t> integers(field.values.begin(), field.values.end());
      hdf5::write_dataset(data, field.name, shape, integers.data());
    } else {
      hdf5::write_dataset(data, field.name, shape, field.values.data());
    }
    const hdf5::Handle dataset(H5Dopen2(data, field.name.c_str(), H5P_DEFAULT), H5Dclose, field.name.c_str());
    hdf5::write_attribute(dataset, "unit", field.unit);
  }
  write_base(file.root(), snapshot.base);
  return file.bytes();
}

template <int Dim>
std::size_t snapshot_bytes_of_particle(const mpm::Particles<Dim>& particles) {
  std::size_t numbers = 3 + 2;  // coordinates, and two numbers of the vertex
  for (const SnapshotField& field : snapshot_fields(particles)) {
    numbers += field.components;
  }
  return numbers * sizeof(double);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                      \
  template std::vector<SnapshotField> snapshot_fields<Dim>(const mpm::Particles<Dim>&); \
  template std::size_t snapshot_bytes_of_particle<Dim>(const mpm::Particles<Dim>&);     \
  template std::vector<std::size_t> order_by_id<Dim>(const mpm::Particles<Dim>&);       \
  template Snapshot make_snapshot<Dim>(const mpm::Particles<Dim>&, const Vector<double, Dim>&, double, std::int64_t);
THAWSLIDE_INSTANTIATE(2)
THAWSLIDE_INSTANTIATE(3)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::io
