// The snapshots of a run: a file each, and an index that lets readers open them as one series.
#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "io/snapshot.hpp"

namespace thawslide::io {

// What is missing among the snapshots of a run that has ended, by their numbers; empty: nothing that these tell.
[[nodiscard]] std::string gap_in_snapshots(const std::filesystem::path& folder);

class SnapshotSeries {
 public:
  // Starts with no snapshots; makes folder/snapshots.
  explicit SnapshotSeries(const std::filesystem::path& folder);
  // Goes on with the series after its first `count` snapshots: later ones are removed. A note says which of the earlier
  // ones are missing or cannot be read; the index leaves these out.
  static SnapshotSeries continue_after(const std::filesystem::path& folder, std::size_t count,
                                       std::vector<std::string>& warnings);

  // Writes folder/snapshots/NNNNNN.vtkhdf while the caller goes on, and before that, when it was not written for some
  // seconds, the index of the snapshots so far. Throws WriteError if this snapshot or the one before it could not be
  // written.
  void add(Snapshot snapshot);
  // Waits until the last snapshot is on the disk; throws as add does.
  void finish_writing();
  // Writes folder/particles.vtkhdf: virtual datasets over all snapshots so far, with their times. None: there is none.
  void write_index();

  // How many were written, whatever has become of them.
  [[nodiscard]] std::size_t size() const { return next_; }
  // Processor time that snapshots took while the caller went on [s], but for the last one if it is still being written.
  [[nodiscard]] double writer_seconds() const { return writer_seconds_; }

 private:
  struct Entry {
    std::size_t number;
    double time;
    std::size_t particles;
  };
  struct Column {
    std::string name, unit;
    std::size_t components;
    bool integer;
  };
  bool take(std::size_t number, const std::filesystem::path& file);
  void write_cells(std::int64_t root, const std::vector<std::int64_t>& counts) const;
  void write_steps(std::int64_t root) const;
  void write_virtual(std::int64_t parent, const std::string& name, const std::string& source, std::size_t components,
                     std::size_t extra_rows, bool integer) const;

  std::filesystem::path folder_;
  std::vector<Entry> entries_;  // of those that can be read
  std::size_t next_ = 0;        // number of the next one
  std::vector<Column> columns_;
  std::chrono::steady_clock::time_point indexed_;
  std::future<double> writing_;  // the last snapshot; HDF5 is in one thread's hands at a time
  double writer_seconds_ = 0.0;
};

}  // namespace thawslide::io
