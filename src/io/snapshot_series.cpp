#include "io/snapshot_series.hpp"

#include <ctime>

#include "io/atomic_file.hpp"
#include "io/vtkhdf.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

constexpr double seconds_between_indices = 5.0;

std::string file_name(std::size_t number) { return fmt::format("snapshots/{:06d}.vtkhdf", number); }

double read_number(hid_t object, const char* name) {
  const hdf5::Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  double value = 0.0;
  THAWSLIDE_ASSERT(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0, "attribute {} cannot be read", name);
  return value;
}

std::string read_unit(hid_t dataset) {
  const hdf5::Handle attribute(H5Aopen(dataset, "unit", H5P_DEFAULT), H5Aclose, "unit");
  const hdf5::Handle type(H5Aget_type(attribute), H5Tclose, "unit's type");
  std::string text(H5Tget_size(type), '\0');
  THAWSLIDE_ASSERT(H5Aread(attribute, type, text.data()) >= 0, "attribute unit cannot be read");
  return text;
}

}  // namespace

SnapshotSeries::SnapshotSeries(const fs::path& folder) : folder_(folder), indexed_() {
  make_folder(folder / "snapshots");
}

SnapshotSeries SnapshotSeries::continue_after(const fs::path& folder, double time) {
  SnapshotSeries series(folder);
  for (std::size_t k = 0; fs::exists(folder / file_name(k)); ++k) {
    const fs::path file = folder / file_name(k);
    bool later = false;
    {
      const hdf5::Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, file.c_str());
      const hdf5::Handle root(H5Gopen2(opened, "VTKHDF", H5P_DEFAULT), H5Gclose, "VTKHDF");
      const double at = read_number(root, "time");
      later = at > time * (1.0 + 1e-12);
      if (!later) {
        const hdf5::Handle data(H5Gopen2(root, "PointData", H5P_DEFAULT), H5Gclose, "PointData");
        H5G_info_t info{};
        H5Gget_info(data, &info);
        series.columns_.clear();
        std::size_t particles = 0;
        for (hsize_t field = 0; field < info.nlinks; ++field) {
          char name[256];
          H5Lget_name_by_idx(data, ".", H5_INDEX_NAME, H5_ITER_INC, field, name, sizeof name, H5P_DEFAULT);
          const hdf5::Handle dataset(H5Dopen2(data, name, H5P_DEFAULT), H5Dclose, name);
          const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "space");
          const hdf5::Handle type(H5Dget_type(dataset), H5Tclose, "type");
          hsize_t shape[2] = {0, 1};
          H5Sget_simple_extent_dims(space, shape, nullptr);
          particles = shape[0];
          series.columns_.push_back({name, read_unit(dataset), shape[1], H5Tget_class(type) == H5T_INTEGER});
        }
        series.entries_.push_back({at, particles});
      }
    }
    if (later) {
      fs::remove(file);
    }
  }
  return series;
}

void SnapshotSeries::finish_writing() {
  if (writing_.valid()) {
    seconds_beside_ += writing_.get();
  }
}

void SnapshotSeries::add(Snapshot snapshot) {
  finish_writing();
  const auto now = std::chrono::steady_clock::now();
  if (!entries_.empty() && std::chrono::duration<double>(now - indexed_).count() > seconds_between_indices) {
    write_index();
  }
  const fs::path file = folder_ / file_name(entries_.size());
  const Entry entry{snapshot.time, snapshot.particles()};
  columns_.clear();
  for (const SnapshotField& field : snapshot.fields) {
    columns_.push_back({field.name, field.unit, field.components, field.integer});
  }
  writing_ = std::async(std::launch::async, [file, snapshot = std::move(snapshot)]() mutable {
    const std::vector<std::byte> bytes = snapshot_bytes(snapshot);
    snapshot = {};
    write_file_atomically(file, bytes.data(), bytes.size());
    timespec spent{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
  });
  entries_.push_back(entry);
}

// One dataset of the index: the rows of all snapshots, one after another. extra_rows: rows beyond the particle count.
void SnapshotSeries::write_virtual(std::int64_t parent, const std::string& name, const std::string& source,
                                   std::size_t components, std::size_t extra_rows, bool integer) const {
  hsize_t rows = 0;
  for (const Entry& entry : entries_) {
    rows += entry.particles + extra_rows;
  }
  const int rank = components == 1 ? 1 : 2;
  const hsize_t shape[2] = {rows, components};
  const hdf5::Handle space(H5Screate_simple(rank, shape, nullptr), H5Sclose, "a space");
  const hdf5::Handle creation = hdf5::dataset_creation();
  hsize_t start[2] = {0, 0};
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const hsize_t part[2] = {entries_[k].particles + extra_rows, components};
    const hdf5::Handle from(H5Screate_simple(rank, part, nullptr), H5Sclose, "a space");
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, part, nullptr);
    THAWSLIDE_ASSERT(H5Pset_virtual(creation, space, file_name(k).c_str(), source.c_str(), from) >= 0,
                     "virtual dataset {} of snapshot {}", name, k);
    start[0] += part[0];
  }
  H5Sselect_all(space);
  const hid_t type = integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
  const hdf5::Handle dataset(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                             H5Dclose, name.c_str());
}

void SnapshotSeries::write_cells(std::int64_t root, const std::vector<std::int64_t>& counts) const {
  const hsize_t steps = entries_.size();
  const std::vector<std::int64_t> zeros(entries_.size(), 0);
  for (const char* kind : vtkhdf::cell_kinds) {
    const bool vertices = kind == vtkhdf::cell_kinds[0];
    const hdf5::Handle group = hdf5::make_group(root, kind);
    const auto& numbers = vertices ? counts : zeros;
    hdf5::write_dataset(group, "NumberOfCells", {steps}, numbers.data());
    hdf5::write_dataset(group, "NumberOfConnectivityIds", {steps}, numbers.data());
    if (vertices) {
      write_virtual(group, "Offsets", "/VTKHDF/Vertices/Offsets", 1, 1, true);
      write_virtual(group, "Connectivity", "/VTKHDF/Vertices/Connectivity", 1, 0, true);
    } else {
      hdf5::write_dataset(group, "Offsets", {steps}, zeros.data());
      hdf5::write_dataset(group, "Connectivity", {0}, zeros.data());
    }
  }
}

void SnapshotSeries::write_steps(std::int64_t root) const {
  const hsize_t steps = entries_.size();
  const hdf5::Handle group = hdf5::make_group(root, "Steps");
  hdf5::write_attribute(group, "NSteps", static_cast<std::int64_t>(steps));
  std::vector<double> times;
  std::vector<std::int64_t> numbers, ones, points, cells;
  std::int64_t sum = 0;
  for (const Entry& entry : entries_) {
    numbers.push_back(static_cast<std::int64_t>(times.size()));
    times.push_back(entry.time);
    ones.push_back(1);
    points.push_back(sum);
    cells.insert(cells.end(), {sum, 0, 0, 0});
    sum += static_cast<std::int64_t>(entry.particles);
  }
  hdf5::write_dataset(group, "Values", {steps}, times.data());
  hdf5::write_dataset(group, "PartOffsets", {steps}, numbers.data());
  hdf5::write_dataset(group, "NumberOfParts", {steps}, ones.data());
  hdf5::write_dataset(group, "PointOffsets", {steps}, points.data());
  hdf5::write_dataset(group, "CellOffsets", {steps, 4}, cells.data());
  hdf5::write_dataset(group, "ConnectivityIdOffsets", {steps, 4}, cells.data());
  const hdf5::Handle offsets = hdf5::make_group(group, "PointDataOffsets");
  for (const Column& column : columns_) {
    hdf5::write_dataset(offsets, column.name, {steps}, points.data());
  }
}

void SnapshotSeries::write_index() {
  finish_writing();
  const hdf5::MemoryFile file;
  const hdf5::Handle root = vtkhdf::make_root(file.root());
  std::vector<std::int64_t> counts;
  for (const Entry& entry : entries_) {
    counts.push_back(static_cast<std::int64_t>(entry.particles));
  }
  hdf5::write_dataset(root, "NumberOfPoints", {counts.size()}, counts.data());
  write_virtual(root, "Points", "/VTKHDF/Points", 3, 0, false);
  write_cells(root, counts);
  {
    const hdf5::Handle data = hdf5::make_group(root, "PointData");
    for (const Column& column : columns_) {
      write_virtual(data, column.name, "/VTKHDF/PointData/" + column.name, column.components, 0, column.integer);
      const hdf5::Handle dataset(H5Dopen2(data, column.name.c_str(), H5P_DEFAULT), H5Dclose, column.name.c_str());
      hdf5::write_attribute(dataset, "unit", column.unit);
    }
  }
  write_steps(root);
  const std::vector<std::byte> bytes = file.bytes();
  write_file_atomically(folder_ / "particles.vtkhdf", bytes.data(), bytes.size());
  indexed_ = std::chrono::steady_clock::now();
}

}  // namespace thawslide::io
