#include "io/snapshot_series.hpp"

#include <charconv>
#include <map>

#include "base/atomic_file.hpp"
#include "base/clocks.hpp"
#include "io/files.hpp"
#include "io/hdf5_file.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;

namespace {

constexpr double seconds_between_indices = 5.0;

std::string file_name(std::size_t number) { return fmt::format("snapshots/{:06d}.vtkhdf", number); }

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

SnapshotSeries::SnapshotSeries(const fs::path& folder) : folder_(folder) { make_folder(folder / "snapshots"); }

SnapshotSeries SnapshotSeries::continue_after(const fs::path& folder, const std::vector<double>& state,
                                              std::vector<SnapshotField> fields, std::vector<std::string>& warnings) {
  SnapshotSeries series(folder);
  series.fields_ = std::move(fields);
  StateNumbers numbers(state, "snapshots");
  const auto next_whole = [&] { return static_cast<std::size_t>(numbers.whole(largest_whole)); };
  series.next_ = next_whole();
  std::string lost;
  std::size_t expected = 0;
  const auto report_lost_before = [&](std::size_t number) {
    if (expected < number) {
      lost += fmt::format("{}{:06d}", lost.empty() ? "" : ", ", expected);
      lost += number - expected > 1 ? fmt::format(" to {:06d}", number - 1) : "";
    }
  };
  while (numbers.left() > 0) {
    const Entry entry{next_whole(), numbers.next_finite(), next_whole(), next_whole()};
    const fs::path file = folder / file_name(entry.number);
    if (fs::is_regular_file(file) && fs::file_size(file) == entry.bytes) {
      report_lost_before(entry.number);
      expected = entry.number + 1;
      series.entries_.push_back(entry);
    }
  }
  report_lost_before(series.next_);
  if (!lost.empty()) {
    warnings.push_back(
        fmt::format("of the {} snapshots up to here these are missing or damaged: {}; particles.vtkhdf omits them",
                    series.next_, lost));
  }
  for (const auto& [number, file] : numbered_files(folder / "snapshots")) {
    if (number >= series.next_) {
      remove_or_throw(file);
    }
  }
  return series;
}

std::vector<double> SnapshotSeries::state() const {
  std::vector<double> numbers{static_cast<double>(next_)};
  for (const Entry& entry : entries_) {
    numbers.insert(numbers.end(), {static_cast<double>(entry.number), entry.time, static_cast<double>(entry.particles),
                                   static_cast<double>(entry.bytes)});
  }
  return numbers;
}

void SnapshotSeries::finish_writing() {
  if (writing_.valid()) {
    const Written written = writing_.get();
    writer_seconds_ += written.seconds;
    entries_.back().bytes = written.bytes;
  }
}

void SnapshotSeries::add(Snapshot snapshot) {
  finish_writing();
  if (!entries_.empty() && wall_clock() - indexed_ > seconds_between_indices) {
    write_index();
  }
  const fs::path file = folder_ / file_name(next_);
  const Entry entry{next_++, snapshot.time, snapshot.particles(), 0};
  fields_.clear();
  for (const SnapshotField& field : snapshot.fields) {
    fields_.push_back({field.name, field.unit, field.components, field.integer, {}});
  }
  writing_ = std::async(std::launch::async, [file, snapshot = std::move(snapshot)]() mutable {
    const std::vector<std::byte> bytes = snapshot_bytes(snapshot);
    snapshot = {};
    write_file_atomically(file, bytes.data(), bytes.size());
    return Written{thread_clock(), bytes.size()};
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
  for (const SnapshotField& field : fields_) {
    hdf5::write_dataset(offsets, field.name, {steps}, points.data());
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
    for (const SnapshotField& field : fields_) {
      write_virtual(data, field.name, "/VTKHDF/PointData/" + field.name, field.components, 0, field.integer);
      const hdf5::Handle dataset(H5Dopen2(data, field.name.c_str(), H5P_DEFAULT), H5Dclose, field.name.c_str());
      hdf5::write_attribute(dataset, "unit", field.unit);
    }
  }
  write_steps(root);
  const std::vector<std::byte> bytes = file.bytes();
  write_file_atomically(folder_ / "particles.vtkhdf", bytes.data(), bytes.size());
  indexed_ = wall_clock();
}

}  // namespace thawslide::io
