// Snapshots of a run: one file each, and an index with which readers open them as a series.
#pragma once

#include <cmath>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "io/snapshot.hpp"

namespace thawslide::io {

class SnapshotSeries {
 public:
  // Starts with no snapshots; creates folder/snapshots.
  explicit SnapshotSeries(const std::filesystem::path& folder);
  // Continues a series with this state; warns about missing snapshots. fields: of its next snapshot, without values.
  static SnapshotSeries continue_after(const std::filesystem::path& folder, const std::vector<double>& state,
                                       std::vector<SnapshotField> fields, std::vector<std::string>& warnings);

  // Writes folder/snapshots/NNNNNN.vtkhdf in parallel with the caller, and an index that is some seconds old. Throws
  // WriteError if this snapshot or the previous one could not be written.
  void add(Snapshot snapshot);
  // Waits until the last snapshot has reached the disk; throws as add does.
  void finish_writing();
  // Writes folder/particles.vtkhdf: virtual datasets over all snapshots so far, with their times; nothing without any.
  void write_index();

  // State for a checkpoint, once all are written: their number; number, time, particles and bytes of each in the index.
  [[nodiscard]] std::vector<double> state() const;
  // CPU time of writing snapshots in parallel with the caller [s], without the last one while it is being written.
  [[nodiscard]] double writer_seconds() const { return writer_seconds_; }

 private:
  struct Entry {
    std::size_t number;
    double time;
    std::size_t particles, bytes;  // bytes: of the file, once written
  };
  struct Written {
    double seconds;  // of CPU time
    std::size_t bytes;
  };
  void write_cells(std::int64_t root, const std::vector<std::int64_t>& counts) const;
  void write_steps(std::int64_t root) const;
  void write_virtual(std::int64_t parent, const std::string& name, const std::string& source, std::size_t components,
                     std::size_t extra_rows, bool integer) const;

  std::filesystem::path folder_;
  std::vector<Entry> entries_;         // readable snapshots
  std::size_t next_ = 0;               // number of the next one
  std::vector<SnapshotField> fields_;  // of the last snapshot, without values
  double indexed_ = -HUGE_VAL;         // wall-clock time of the last index
  std::future<Written> writing_;       // the last snapshot; HDF5 is used by one thread at a time
  double writer_seconds_ = 0.0;
};

}  // namespace thawslide::io
