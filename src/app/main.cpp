// Command line: options, commands and exit codes (listed in scripts/command_line_page.md).
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "version.hpp"

namespace {

using thawslide::ExitCode;
using namespace thawslide::app;

void add_case_options(CLI::App& command, CaseOptions& options) {
  command.add_option("case", options.file, "Case file, or the folder of a case.toml")->required();
  command
      .add_option("--set", options.sets,
                  "Value of a key, in place of that of the case file: --set band.thickness=0.1 (may be repeated)")
      ->take_all()
      ->allow_extra_args(false);
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Maximum number of threads (default: the cores available to the process)")
      ->check(CLI::Range(1, 1024));
}

void add_device_option(CLI::App& command, std::string& device) {
  command
      .add_option("--device", device,
                  "Device that computes the time steps: cpu, gpu (an NVIDIA GPU) or auto (default: cpu)")
      ->check(CLI::IsMember({"cpu", "gpu", "auto"}));
}

std::string is_no_empty_name(const std::string& folder) { return folder.empty() ? "name a folder" : ""; }

// Replaces CLI11's own check, whose message prints the largest floating-point number.
CLI::Validator above_zero() {
  return {[](std::string& text) {
            double number = 0.0;
            if (!CLI::detail::lexical_cast(text, number)) {
              return fmt::format("{} found; allowed: a number above 0, without a unit{}", text,
                                 thawslide::comma_advice(text));
            }
            return number > 0.0 && std::isfinite(number) ? std::string()
                                                         : fmt::format("{} found; allowed: above 0", text);
          },
          "above 0"};
}

// Returns the option of the release.
CLI::Option* add_map_options(CLI::App& command, MapOptions& maps) {
  command.add_option("--dem", maps.dem, "DEM in projected metres: GeoTIFF or ESRI ASCII grid")->required();
  CLI::Option* release = command.add_option(
      "--release", maps.release, "Release: polygons (Shapefile, GeoPackage or GeoJSON), or a raster of the thickness");
  command
      .add_option("--thickness", maps.thickness,
                  "Vertical thickness of the release in the polygons [m] (default: their attribute 'thickness')")
      ->check(above_zero())
      ->needs(release);
  auto* placement = command.add_option_group("placement");
  placement->add_flag("--cut", maps.cut, "Cut the release out of the DEM, which is then the surface before the event")
      ->needs(release);
  placement->add_flag("--on-top")
      ->description("Place the release on top of the DEM (default)")
      ->needs(release)
      ->excludes(placement->get_option("--cut"));
  command.add_option(
      "--crs", maps.crs,
      "Coordinate reference system of a DEM whose file has none, such as EPSG:31287 (default: as in the file)");
  return release;
}

// Reports a misspelt command with the most similar valid one.
void require_known_command(const CLI::App& program, int count, char** arguments) {
  if (count < 2 || arguments[1][0] == '-') {
    return;
  }
  std::vector<std::string> commands;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands.push_back(command->get_name());
    if (command->get_name() == arguments[1]) {
      return;
    }
  }
  throw thawslide::UserError("there is no command '{}'{} Commands: {}. Run with --help for more information.",
                             arguments[1], thawslide::config::did_you_mean(arguments[1], commands, "."),
                             thawslide::config::comma_list(commands));
}

// Reports lost output, and returns the exit code. A closed pipe is not an error, because the reader has read enough.
int end_without_output(std::error_code reason, int code) {
  if (reason == std::errc::broken_pipe) {
    return code;
  }
  print_error("error: the output cannot be written: {}. Redirect it to a disk with free space.\n", reason.message());
  return static_cast<int>(ExitCode::not_written);
}

// Returns the exit code of a command that returned `code`, after its results have been flushed.
int with_output_written(int code) {
  errno = 0;
  const bool is_flushed = std::fflush(stdout) == 0;
  const std::error_code reason(errno != 0 ? errno : EIO, std::generic_category());
  return is_flushed && std::ferror(stdout) == 0 ? code : end_without_output(reason, code);
}

int run_program(int count, char** arguments) {
  CLI::App program("Thawslide: rock-ice avalanches by a three-phase material point method", "thawslide");
  program.require_subcommand(1);
  program.set_version_flag("--version", version_text);
  int exit_code = 0;

  RunOptions run_options;
  CLI::App* run = program.add_subcommand("run", "Run a case");
  add_case_options(*run, run_options.of_case);
  add_threads_option(*run, run_options.threads);
  add_device_option(*run, run_options.device);
  run->add_option("--end", run_options.end, "End of the run [s]; short for --set time.end=END")->check(above_zero());
  run->add_option("--output", run_options.output, "Folder of the results (default: runs/NAME)")
      ->check(is_no_empty_name);
  run->add_flag("--overwrite", run_options.overwrite, "Replace the run in the folder of the results");
  run->add_flag("--pair", run_options.pair,
                "Run on cells of twice and four times the size as well, and report results with their errors (calls "
                "thawslide-pair; default folder: runs/NAME-pair)");
  run->callback([&] { exit_code = run_case(run_options); });

  ResumeOptions resume_options;
  CLI::App* resume = program.add_subcommand("resume", "Continue a run from its checkpoint");
  resume->add_option("run", resume_options.folder, "Folder of the run")->required();
  add_threads_option(*resume, resume_options.threads);
  add_device_option(*resume, resume_options.device);
  resume
      ->add_option("--set", resume_options.sets,
                   "Change a key for the rest of the run: --set time.output_interval=5 (may be repeated). The run "
                   "records the change")
      ->take_all()
      ->allow_extra_args(false);
  resume->add_option("--end", resume_options.end, "New end of the run [s]; short for --set time.end=END")
      ->check(above_zero());
  resume->callback([&] { exit_code = resume_run(resume_options); });

  std::string status_folder;
  bool status_json = false;
  CLI::App* status =
      program.add_subcommand("status", "Report whether a run is active, its progress, and how to continue it");
  status->add_option("run", status_folder, "Folder of the run")->required();
  status->add_flag("--json", status_json, "Print JSON");
  status->callback([&] { exit_code = print_status(status_folder, status_json); });

  CheckOptions check_options;
  CLI::App* check = program.add_subcommand("check", "Validate a case and estimate the cost of its run");
  add_case_options(*check, check_options.of_case);
  add_threads_option(*check, check_options.threads);
  CLI::Option* picture = check->add_option(
      "--picture", check_options.picture,
      "Plot terrain, grid, bodies and boundaries to a PNG file (default: setup.png next to the case file)");
  picture->expected(0, 1);
  check->add_flag("--json", check_options.json, "Print JSON");
  check->callback([&] {
    check_options.draws = picture->count() > 0;
    exit_code = check_case(check_options);
  });

  CaseOptions block_case;
  std::string block_output;
  CLI::App* block = program.add_subcommand("block", "Simulate a case as a rigid block, in less than a second");
  add_case_options(*block, block_case);
  block->add_option("--output", block_output, "CSV file of the results (default: some rows are printed)");
  block->callback([&] { exit_code = run_block_model(block_case, block_output); });

  NewOptions new_options;
  CLI::App* make_new = program.add_subcommand("new", "Create a case folder from a DEM and a release area");
  make_new->add_option("folder", new_options.folder, "Folder to create")->required();
  add_map_options(*make_new, new_options.maps)->required();
  make_new
      ->add_option("--reach-angle", new_options.reach_angle,
                   "Extent of the domain: it includes all terrain below a line that descends at this angle from the "
                   "top of the release [degrees]")
      ->check(above_zero())
      ->check(CLI::Range(1.0, 45.0))
      ->option_text("1 to 45, default 8");
  CLI::Option* cell = make_new->add_option("--cell", new_options.cell, "Side length of a grid cell [m]")
                          ->check(above_zero())
                          ->option_text("default: that of --resolution");
  make_new
      ->add_option("--resolution", new_options.resolution,
                   "Cell size. quick: two cells across the thickness of the release; standard: four across its median "
                   "thickness; fine: eight")
      ->check(CLI::IsMember({"quick", "standard", "fine"}))
      ->excludes(cell)
      ->option_text("default quick");
  make_new
      ->add_option(
          "--largest-volume", new_options.maps.largest_volume,
          "Maximum volume of the release [m3], to confirm a large one (default: that of body.NAME.largest_volume)")
      ->check(above_zero());
  for (const thawslide::config::ProposedSubstrate& each : thawslide::config::proposed_substrates) {
    make_new
        ->add_option(each.option, new_options.outlines[each.name],
                     fmt::format("Polygons of this ground on the path: a substrate with a friction coefficient of {} "
                                 "({} to {} in sweep.toml; assumed)",
                                 each.coefficient, each.low, each.high))
        ->option_text("FILE");
  }
  new_options.program = arguments[0];
  make_new->callback([&] { exit_code = make_new_case(new_options); });

  SectionOptions section_options;
  CLI::App* section = program.add_subcommand("section", "Cut a 2D case out of a DEM, along a line");
  section->add_option("folder", section_options.folder, "Folder to create")->required();
  section
      ->add_option("--line", section_options.line, "File of the line, drawn downhill: Shapefile, GeoPackage or GeoJSON")
      ->required();
  add_map_options(*section, section_options.maps)
      ->description(
          "Release: polygons (Shapefile, GeoPackage or GeoJSON), or a raster of the thickness (default: only the "
          "profile is cut)");
  section_options.program = arguments[0];
  section->callback([&] { exit_code = make_section(section_options); });

  DescribeOptions describe_options;
  CLI::App* describe =
      program.add_subcommand("describe", "Print the reference of the case file, or of the output of a run");
  auto* forms = describe->add_option_group("form");
  forms->add_flag("--json", describe_options.json, "Print JSON");
  forms->add_flag("--md", describe_options.markdown, "Print Markdown");
  forms->add_flag("--schema", describe_options.schema, "Print a JSON schema, for editors");
  forms->add_flag("--outputs", describe_options.outputs, "Print the columns, datasets and maps of a run as Markdown");
  forms->require_option(0, 1);
  describe->callback([&] { exit_code = describe_parameters(describe_options); });

  // Commands of the Python package; --help is theirs.
  const auto add_python_command = [&](const std::string& name, const std::string& description) {
    CLI::App* command = program.add_subcommand(name, fmt::format("{} (calls thawslide-{})", description, name));
    command->prefix_command();
    command->set_help_flag();
    command->callback([&exit_code, command, name] { exit_code = run_python_command(name, command->remaining()); });
  };
  add_python_command("report", "Plot the figures of a run");
  add_python_command("sweep", "Run a case many times with varied keys");
  add_python_command("scarp", "Build a release from a failure surface below a DEM");
  add_python_command("probability", "Map probabilities and quantiles of many runs");
  add_python_command("terrain", "Write the terrain after a run, for a next event");
  add_python_command("export", "Write a run for wave and flood codes");
  add_python_command("assets", "List pressure, thickness and speed at assets");
  add_python_command("score", "Compare a sweep or a run with observations");
  add_python_command("forecast", "Simulate the members of a case's sweep.toml, with a prior check and a summary");

  CLI::App* show_version = program.add_subcommand("version", "Print version, commit and build");
  show_version->callback([&] { exit_code = print_version(); });

  require_known_command(program, count, arguments);
  try {
    program.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return with_output_written(program.exit(error));  // --help
    }
    throw thawslide::UserError("{}. Run with --help for more information.", error.what());
  }
  // A run continues without a terminal, because its results are files.
  return run->parsed() || resume->parsed() ? exit_code : with_output_written(exit_code);
}

// Escapes control characters, because names of files, attributes and others come from external sources.
std::string printable(std::string text) { return thawslide::config::printable(std::move(text), "\n\t"); }

// Last resort.
int end_with_internal_error(const std::string& error) {
  print_error("error: internal error of thawslide {} {}, please report it with the command line: {}\n",
              thawslide::version, thawslide::commit, error);
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file above its size limit becomes an error of the writing call
  thawslide::set_passive_wait(arguments);
  try {
    return run_program(count, arguments);
  } catch (const thawslide::UserError& error) {
    print_error("error: {}\n", printable(error.what()));
    const bool is_written = dynamic_cast<const thawslide::WriteError*>(&error) == nullptr;
    return static_cast<int>(is_written ? ExitCode::user_mistake : ExitCode::not_written);
  } catch (const thawslide::RunError& error) {
    print_error("error: {}\n", printable(error.what()));
    return static_cast<int>(ExitCode::run_failed);
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string paths = error.path1().string() + (error.path2().empty() ? "" : " and " + error.path2().string());
    print_error("error: {}: {}\n", printable(paths), error.code().message());
    return static_cast<int>(ExitCode::user_mistake);
  } catch (const std::bad_alloc&) {
    print_error(
        "error: the memory of this machine, or what a limit allows of it (ulimit -v), is not enough. Make grid.cell "
        "larger: twice the cell takes an eighth of the memory in 3D and a quarter in 2D.\n");
    return static_cast<int>(ExitCode::user_mistake);
  } catch (const std::exception& error) {
    // fmt reports a failed write of a command's output by this exception.
    const auto* of_system = dynamic_cast<const std::system_error*>(&error);
    if (of_system != nullptr && std::ferror(stdout) != 0) {
      return end_without_output(of_system->code(), static_cast<int>(ExitCode::done));
    }
    return end_with_internal_error(printable(error.what()));
  } catch (...) {
    return end_with_internal_error("an exception of unknown type");
  }
}
