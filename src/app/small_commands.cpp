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
#include "app/describe_outputs.hpp"
#include "app/python_program.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/describe.hpp"
#include "config/read_case.hpp"
#include "io/history_writer.hpp"
#include "run/block_model.hpp"
#include "run/input_files.hpp"
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

}  // namespace

int run_block_model(const BlockOptions& options) {
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  if (!options.output.empty()) {
    run::require_no_input_at(options.output, "--output", parameters);
  }
  Terminal terminal;
  const std::vector<sim::HistoryRow> rows = run::block_rows(parameters, terminal);
  if (options.output.empty()) {
    print_table(rows);
    const auto& first = rows.front();
    fmt::print("safety factor at the start: {:.3f} (sliding strength over driving traction)\n",
               run::value_of(first, "sliding_strength_Pa") / std::abs(run::value_of(first, "driving_traction_Pa")));
    return static_cast<int>(ExitCode::done);
  }
  io::HistoryWriter writer(options.output);
  for (const sim::HistoryRow& row : rows) {
    writer.add(row);
  }
  fmt::print("{} rows in {}\n", rows.size(), options.output);
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
