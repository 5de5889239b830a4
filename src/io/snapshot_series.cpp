#include "io/snapshot_series.hpp"

#include <charconv>
#include <cmath>
#include <map>

#include "base/atomic_file.hpp"
#include "base/clocks.hpp"
#include "config/input_limits.hpp"
#include "io/files.hpp"
#include "io/hdf5_file.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

constexpr double seconds_between_indices = 5.0;

std::string file_name(std::size_t number) { return fmt::format("snapshots/{:06d}.vtkhdf", number); }

// Type of an attribute, which must be scalar: the library writes as many values as the file specifies.
hdf5::Handle type_of_one_value(hid_t attribute, const char* name) {
  const hdf5::Handle space(H5Aget_space(attribute), H5Sclose, name);
  THAWSLIDE_ASSERT(H5Sget_simple_extent_type(space) == H5S_SCALAR, "attribute {} is not one value", name);
  return {H5Aget_type(attribute), H5Tclose, name};
}

double read_number(hid_t object, const char* name) {
  const hdf5::Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const hdf5::Handle type = type_of_one_value(attribute, name);
  THAWSLIDE_ASSERT(H5Tget_class(type) == H5T_FLOAT, "attribute {} is no number", name);
  double value = 0.0;
  THAWSLIDE_ASSERT(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0, "attribute {} cannot be read", name);
  THAWSLIDE_ASSERT(std::isfinite(value), "attribute {} is {}", name, value);
  return value;
}

std::string read_unit(hid_t dataset) {
  const hdf5::Handle attribute(H5Aopen(dataset, "unit", H5P_DEFAULT), H5Aclose, "unit");
  const hdf5::Handle type = type_of_one_value(attribute, "unit");
  // The library returns a pointer for a text of variable length.
  THAWSLIDE_ASSERT(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0,
                   "attribute unit is no plain text");
  const std::size_t size = H5Tget_size(type);
  std::string text(size, '\0');
  THAWSLIDE_ASSERT(H5Aread(attribute, type, text.data()) >= 0, "attribute unit cannot be read");
  return text;
}

std::string name_of_field(hid_t group, hsize_t number) {
  char name[256] = "";
  const ssize_t length =
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, number, name, sizeof name, H5P_DEFAULT);
  THAWSLIDE_ASSERT(length > 0 && static_cast<std::size_t>(length) < sizeof name, "field {} of a snapshot", number);
  return name;
}

struct FieldShape {
  hsize_t rows, components;
};

FieldShape shape_of(hid_t dataset) {
  const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "space");
  hsize_t shape[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  THAWSLIDE_ASSERT(rank == 1 || rank == 2, "a field of {} dimensions", rank);
  H5Sget_simple_extent_dims(space, shape, nullptr);
  return {shape[0], shape[1]};
}

// Files NNNNNN.vtkhdf by number.
std::map<std::size_t, fs::path> numbered_files(const fs::path& folder) {
  std::map<std::size_t, fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (error == std::errc() && end == stem.data() + stem.size() &&
        entry.path().filename() == fs::path(file_name(number)).filename()) {
      files.emplace(number, entry.path());
    }
  }
  return files;
}

}  // namespace

SnapshotSeries::SnapshotSeries(const fs::path& folder) : folder_(folder), indexed_() {
  make_folder(folder / "snapshots");
}

SnapshotSeries SnapshotSeries::continue_after(const fs::path& folder, std::size_t count,
                                              std::vector<std::string>& warnings) {
  SnapshotSeries series(folder);
  series.next_ = count;
  std::string lost;
  std::size_t expected = 0;
  const auto report_lost_before = [&](std::size_t number) {
    if (expected < number) {
      lost += fmt::format("{}{:06d}", lost.empty() ? "" : ", ", expected);
      lost += number - expected > 1 ? fmt::format(" to {:06d}", number - 1) : "";
    }
  };
  for (const auto& [number, file] : numbered_files(folder / "snapshots")) {
    if (number >= count) {
      remove_or_throw(file);
    } else if (series.restore_snapshot(number, file)) {
      report_lost_before(number);
      expected = number + 1;
    }
  }
  report_lost_before(count);
  if (!lost.empty()) {
    warnings.push_back(fmt::format(
        "of the {} snapshots up to here these are missing or cannot be read: {}; particles.vtkhdf omits them", count,
        lost));
  }
  return series;
}

// Returns whether the file could be read.
bool SnapshotSeries::restore_snapshot(std::size_t number, const fs::path& file) {
  const hdf5::Silence silence;
  if (!config::other_kind_of_file(file).empty()) {
    return false;
  }
  try {
    const hdf5::Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, file.c_str());
    const hdf5::Handle root(H5Gopen2(opened, "VTKHDF", H5P_DEFAULT), H5Gclose, "VTKHDF");
    Entry entry{number, read_number(root, "time"), 0};
    const hdf5::Handle data(H5Gopen2(root, "PointData", H5P_DEFAULT), H5Gclose, "PointData");
    H5G_info_t info{};
    THAWSLIDE_ASSERT(H5Gget_info(data, &info) >= 0, "PointData cannot be read");
    std::vector<Column> columns;
    for (hsize_t field = 0; field < info.nlinks; ++field) {
      const std::string name = name_of_field(data, field);
      const hdf5::Handle dataset(H5Dopen2(data, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str());
      const hdf5::Handle type(H5Dget_type(dataset), H5Tclose, "type");
      const FieldShape shape = shape_of(dataset);
      THAWSLIDE_ASSERT(field == 0 || shape.rows == entry.particles, "{} rows of {}", shape.rows, name);
      entry.particles = shape.rows;
      columns.push_back({name, read_unit(dataset), shape.components, H5Tget_class(type) == H5T_INTEGER});
    }
    entries_.push_back(entry);
    columns_ = std::move(columns);
  } catch (const InternalError&) {  // not written by a run
    return false;
  }
  return true;
}

void SnapshotSeries::finish_writing() {
  if (writing_.valid()) {
    writer_seconds_ += writing_.get();
  }
}

void SnapshotSeries::add(Snapshot snapshot) {
  finish_writing();
  const auto now = std::chrono::steady_clock::now();
  if (!entries_.empty() && std::chrono::duration<double>(now - indexed_).count() > seconds_between_indices) {
    write_index();
  }
  const fs::path file = folder_ / file_name(next_);
  const Entry entry{next_++, snapshot.time, snapshot.particles()};
  columns_.clear();
  for (const SnapshotField& field : snapshot.fields) {
    columns_.push_back({field.name, field.unit, field.components, field.integer});
  }
  writing_ = std::async(std::launch::async, [file, snapshot = std::move(snapshot)]() mutable {
    const std::vector<std::byte> bytes = snapshot_bytes(snapshot);
    snapshot = {};
    write_file_atomically(file, bytes.data(), bytes.size());
    return thread_clock();
  });
  entries_.push_back(entry);
}

// Writes one dataset of the index: the concatenated rows of all snapshots. extra_rows: rows beyond the particle count.
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
    THAWSLIDE_ASSERT(H5Pset_virtual(creation, space, file_name(entries_[k].number).c_str(), source.c_str(), from) >= 0,
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
  for (const char* kind : hdf5::cell_kinds) {
    const bool vertices = kind == hdf5::cell_kinds[0];
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
  if (entries_.empty()) {
    remove_or_throw(folder_ / "particles.vtkhdf");
    return;
  }
  const hdf5::MemoryFile file;
  const hdf5::Handle root = hdf5::make_vtk_root(file.root());
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
