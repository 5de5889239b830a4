// The snapshots of a run: a file each, and an index that lets readers open them as one series.
#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

#include "io/snapshot.hpp"

namespace thawslide::io {

class SnapshotSeries {
 public:
  // Starts with no snapshots; makes folder/snapshots.
  explicit SnapshotSeries(const std::filesystem::path& folder);
  // Goes on with the series: snapshots later than `time` are removed.
  static SnapshotSeries continue_after(const std::filesystem::path& folder, double time);

  // Writes folder/snapshots/NNNNNN.vtkhdf; the index follows when it was not written for some seconds.
  void add(const Snapshot& snapshot);
  // Writes folder/particles.vtkhdf: virtual datasets over all snapshots so far, with their times.
  void write_index();

  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    double time;
    std::size_t particles;
  };
  struct Column {
    std::string name, unit;
    std::size_t components;
    bool integer;
  };
  void write_cells(std::int64_t root, const std::vector<std::int64_t>& counts) const;
  void write_steps(std::int64_t root) const;
  void write_virtual(std::int64_t parent, const std::string& name, const std::string& source, std::size_t components,
                     std::size_t extra_rows, bool integer) const;

  std::filesystem::path folder_;
  std::vector<Entry> entries_;
  std::vector<Column> columns_;
  std::chrono::steady_clock::time_point indexed_;
};

}  // namespace thawslide::io
