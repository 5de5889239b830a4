// thawslide block, describe, report and version.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/describe.hpp"
#include "config/read_case.hpp"
#include "io/history_writer.hpp"
#include "mpm/particles.hpp"
#include "run/block_model.hpp"
#include "run/input_files.hpp"
#include "run/map_output.hpp"
#include "sim/maps/map_kinds.hpp"
#include "sim/records/output_columns.hpp"
#include "version.hpp"

namespace thawslide::app {

namespace {

constexpr std::size_t rows_in_table = 21;

void print_table(const std::vector<sim::HistoryRow>& rows) {
  fmt::print(
      "{:>8} {:>9} {:>10} {:>10} {:>10} {:>10} {:>9} {:>7}\n{:>8} {:>9} {:>10} {:>10} {:>10} {:>10} {:>9} {:>7}\n",
      "time", "velocity", "distance", "normal", "pore p.", "strength", "band T", "mu_e", "s", "m/s", "m", "kPa", "kPa",
      "kPa", "C", "");
  const std::size_t shown = std::min(rows_in_table, rows.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const auto& row = rows[shown == 1 ? 0 : k * (rows.size() - 1) / (shown - 1)];
    const auto value = [&](const std::string& name) { return run::value_of(row, name); };
    fmt::print("{:8.2f} {:9.2f} {:10.1f} {:10.1f} {:10.1f} {:10.1f} {:9.2f} {:7.4f}\n", value("time_s"),
               value("velocity_m_s"), value("displacement_m"), value("normal_pressure_Pa") / 1e3,
               value("pore_pressure_Pa") / 1e3, value("sliding_strength_Pa") / 1e3, value("band_temperature_C"),
               value("band_friction_coefficient"));
  }
}

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

// Tables, datasets and maps of a run, from their declarations: the page "Columns, datasets and maps" of the site.
std::string describe_outputs() {
  return head + history_text() + probes_text() + "\n## Snapshots\n" + fields_text() + base_text() + "\n## Maps\n" +
         maps_text() + block_text();
}

}  // namespace

int run_block_model(const CaseOptions& of_case, const std::string& output) {
  const config::Case parameters = config::read_case(of_case.file, of_case.sets);
  if (!output.empty()) {
    run::require_no_input_at(output, "--output", parameters);
  }
  Terminal terminal;
  const std::vector<sim::HistoryRow> rows = run::block_rows(parameters, terminal);
  if (output.empty()) {
    print_table(rows);
    const auto& first = rows.front();
    fmt::print("safety factor at the start: {:.3f} (sliding strength over driving traction)\n",
               run::value_of(first, "sliding_strength_Pa") / std::abs(run::value_of(first, "driving_traction_Pa")));
    return static_cast<int>(ExitCode::done);
  }
  io::HistoryWriter writer(output);
  for (const sim::HistoryRow& row : rows) {
    writer.add(row);
  }
  fmt::print("{} rows in {}\n", rows.size(), output);
  return static_cast<int>(ExitCode::done);
}

int describe_parameters(const DescribeOptions& options) {
  fmt::print("{}", options.json       ? config::describe_json()
                   : options.markdown ? config::describe_markdown()
                   : options.schema   ? config::schema_json()
                   : options.outputs  ? describe_outputs()
                                      : config::describe_text());
  return static_cast<int>(ExitCode::done);
}

int run_python_command(const std::string& name, const std::vector<std::string>& arguments) {
  std::string program = python_program("thawslide-" + name);
  std::error_code unknown;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (!unknown) {
    setenv("THAWSLIDE_PROGRAM", own.c_str(), 1);  // a sweep estimates its memory with this program
  }
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers{program.data()};
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  execvp(program.c_str(), pointers.data());
  throw UserError("thawslide-{} cannot be started ({}). {}", name, std::strerror(errno), python_program_remedy);
}

std::string version_text() {
#if defined(__clang__)
  const char* const compiler = "clang";
#else
  const char* const compiler = "g++";
#endif
  return fmt::format("thawslide {} (commit {}, {} {})", version, commit, compiler, __VERSION__);
}

int print_version() {
  fmt::print("{}\n", version_text());
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app
