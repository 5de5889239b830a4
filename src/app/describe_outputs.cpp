#include "app/describe_outputs.hpp"

#include <fmt/format.h>

#include "mpm/particles.hpp"
#include "run/map_output.hpp"
#include "sim/maps/map_kinds.hpp"
#include "sim/records/output_columns.hpp"

namespace thawslide::app {

namespace {

constexpr const char* head = R"(# Columns, datasets and maps

This page lists the columns of tables, the datasets of snapshots, and the maps. `thawslide describe --outputs` generates
it. [Output files](outputs.md) describes the files. The unit 1 means dimensionless.
)";

std::string row(const std::string& name, const std::string& unit, const std::string& meaning) {
  return fmt::format("| {} | {} | {} |\n", name, unit, meaning);
}

std::string table(const std::string& first, const std::string& rows) {
  return fmt::format("\n| {} | unit | meaning |\n|---|---|---|\n{}", first, rows);
}

// `force_x_N`, `force_y_N`, `force_z_N` for "force_*_N".
std::string column_name(const std::string& prefix, std::string name) {
  const std::size_t star = name.find('*');
  if (star == std::string::npos) {
    return fmt::format("`{}{}`", prefix, name);
  }
  std::string names;
  for (const char axis : {'x', 'y', 'z'}) {
    name[star] = axis;
    names += fmt::format("{}`{}`", names.empty() ? "" : ", ", name);
  }
  return names;
}

std::string columns_text(const sim::ColumnGroup& group, const std::string& first, const std::string& prefix = "") {
  std::string rows;
  for (const sim::OutputColumn& column : group.columns) {
    rows += row(column_name(prefix, column.name), column.unit, column.meaning);
  }
  const std::string condition = *group.condition == '\0' ? "" : fmt::format("\nWritten {}.\n", group.condition);
  return condition + table(first, rows);
}

std::string title_of(const sim::ColumnGroup& group) { return fmt::format("\n### {}\n", group.title); }

std::string history_text() {
  std::string text =
      "\n## history.csv\n\nColumns with three names have one for each axis of the grid; in 2D there is no z.\n"
      "[Budgets](outputs.md#budgets) states how the terms are related.\n";
  for (const sim::ColumnGroup& group : sim::history_columns()) {
    text += title_of(group) + columns_text(group, "column");
  }
  return text;
}

std::string probes_text() {
  std::string text = "\n## probes.csv\n";
  for (const sim::ColumnGroup& group : sim::probe_columns()) {
    text += title_of(group) + columns_text(group, "column", *group.condition == '\0' ? "" : "NAME_");
  }
  return text;
}

std::string fields_text() {
  const mpm::Particles<3> particles;
  std::string rows;
  for (const mpm::FieldBase* field : particles.fields.all()) {
    if (field->info().in_snapshot()) {
      rows += row(fmt::format("`{}`", field->info().name), field->info().unit, field->info().meaning);
    }
  }
  return "\n### Particles\n\nDatasets of the group `VTKHDF/PointData`.\n" + table("dataset", rows);
}

std::string base_text() {
  const sim::ColumnGroup& group = sim::base_columns();
  return title_of(group) + "\nDatasets of the group `basal_segments`.\n" + columns_text(group, "dataset");
}

std::string maps_text() {
  std::string rows;
  for (const run::GroundMap& map : {run::terrain_map, run::release_map, run::ground_map}) {
    rows += row(fmt::format("`{}`", map.name), map.unit, map.description);
  }
  for (const sim::MapKind& kind : sim::map_kinds()) {
    rows += row(fmt::format("`{}`", kind.name), kind.unit,
                kind.of_last_state ? fmt::format("{}, at the last time", kind.description) : kind.description);
  }
  return table("map", rows);
}

std::string block_text() {
  const sim::ColumnGroup& group = sim::block_columns();
  return fmt::format("\n## {}\n", group.title) + columns_text(group, "column");
}

}  // namespace

std::string describe_outputs() {
  return head + history_text() + probes_text() + "\n## Snapshots\n" + fields_text() + base_text() + "\n## Maps\n" +
         maps_text() + block_text();
}

}  // namespace thawslide::app
