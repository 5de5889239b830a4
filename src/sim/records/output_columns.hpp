// Columns of the tables that a run writes: name, unit and meaning, for the reference page. Tests compare them with the
// tables that are written.
#pragma once

#include <vector>

namespace thawslide::sim {

struct OutputColumn {
  const char* name;  // "*" represents an axis of the grid: x, y and, in 3D, z
  const char* unit;  // "1": dimensionless
  const char* meaning;
};

struct ColumnGroup {
  const char* title;
  const char* condition;  // under which the columns are written; empty: always
  std::vector<OutputColumn> columns;
};

// history.csv.
[[nodiscard]] const std::vector<ColumnGroup>& history_columns();
// probes.csv, without the name of the probe in front, which all but the time have.
[[nodiscard]] const std::vector<ColumnGroup>& probe_columns();
// Group "base" of snapshots.
[[nodiscard]] const ColumnGroup& base_columns();
// Table of the block model.
[[nodiscard]] const ColumnGroup& block_columns();

}  // namespace thawslide::sim
