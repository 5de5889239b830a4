// thawslide status.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/read_case.hpp"
#include "io/checkpoint.hpp"
#include "io/history_writer.hpp"
#include "io/provenance.hpp"
#include "io/run_lock.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

struct RunStatus {
  std::string state;  // running, killed, done, stopped, failed
  std::string message;
  std::string process;                              // of the run; empty: none
  double time = 0.0;                                // simulated [s]
  std::optional<double> end;                        // [s]; empty if the case cannot be read
  std::string case_error;                           // reason why the case cannot be read
  std::string history_error;                        // reason why the history cannot be read; empty if it can
  std::optional<double> checkpoint_age, time_left;  // wall-clock [s]
};

// Converts a UTC time in run.json to its age [s].
std::optional<double> seconds_since(const std::string& utc) {
  std::tm parts{};
  if (strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts) == nullptr) {
    return std::nullopt;
  }
  return std::difftime(std::time(nullptr), timegm(&parts));
}

std::optional<double> age_of(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return error ? std::nullopt
               : std::optional(std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count());
}

// The state of the process is reported even if the case or its disk is unreadable.
void add_end(const fs::path& folder, RunStatus& status) {
  try {
    status.end = config::read_case(folder).time.end;
  } catch (const UserError& error) {
    status.case_error = error.what();
  }
}

// The same for the history; run.json contains a time too, that of its last update.
void add_time(const fs::path& folder, double specified, RunStatus& status) {
  status.time = specified;
  try {
    status.time = std::max(specified, io::last_time_in_history(folder / "history.csv").value_or(0.0));
  } catch (const UserError& error) {
    status.history_error = error.what();
  }
}

// If the last checkpoint is missing, or a kill occurred between two renames, the previous one exists.
std::optional<double> checkpoint_age(const fs::path& folder) {
  for (const char* name : {io::checkpoint_name, io::previous_checkpoint_name}) {
    std::error_code unknown;
    if (fs::is_regular_file(folder / name, unknown)) {
      return age_of(folder / name);
    }
  }
  return std::nullopt;
}

RunStatus status_of(const fs::path& folder) {
  RunStatus status;
  status.process = io::process_at_work(folder);
  const bool is_at_work = !status.process.empty();
  if (!fs::exists(folder / "run.json")) {
    if (!is_at_work) {
      throw UserError("{} is not a run folder: run.json not found. Specify the folder that `thawslide run` printed.",
                      folder.string());
    }
    status.state = "running";
    status.case_error = "the run is setting up and has not written run.json yet";
    return status;
  }
  const io::Provenance facts = io::read_provenance(folder);
  status.state = is_at_work ? "running" : facts.status == "running" ? "killed" : facts.status;
  status.message = is_at_work ? "" : facts.message;
  add_time(folder, facts.simulated_time, status);
  add_end(folder, status);
  status.checkpoint_age = checkpoint_age(folder);
  const io::RunPart& part = facts.parts.back();
  const std::optional<double> elapsed = seconds_since(part.started);
  const bool is_known = elapsed && *elapsed >= 1.0 && status.time > part.from_time;  // run.json is in whole seconds
  if (is_at_work && is_known && status.end) {
    status.time_left = *elapsed * std::max(0.0, *status.end - status.time) / (status.time - part.from_time);
  }
  return status;
}

std::string json_text(const RunStatus& status) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  const nlohmann::ordered_json json{{"state", status.state},
                                    {"message", status.message},
                                    {"process", status.process},
                                    {"simulated_time_s", status.time},
                                    {"end_s", number(status.end)},
                                    {"checkpoint_age_s", number(status.checkpoint_age)},
                                    {"time_left_s", number(status.time_left)}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

// age: [s].
std::string age_text(double age) {
  return age < 0.0 ? "later than it is now by this machine's clock" : duration_text(age) + " ago";
}

std::string status_text(const RunStatus& status) {
  if (status.state == "running") {
    return "running, by " + status.process;
  }
  if (status.state == "killed") {
    return "terminated unexpectedly: the process was killed, the machine stopped, or the disk was full";
  }
  if (status.state == "failed") {
    return status.message.empty() ? "the run failed" : status.message;  // the message begins with these words
  }
  return status.message.empty() ? status.state : status.state + ": " + status.message;
}

std::string continue_text(const fs::path& folder, const RunStatus& status) {
  if (status.state == "killed" || status.state == "stopped") {
    return fmt::format("  to continue: thawslide resume {}\n", shell_quote(folder.string()));
  }
  if (status.state == "failed") {
    return fmt::format(
        "  the message above states what to change. Run the case again with it. If the key may change during a run, "
        "continue: thawslide resume {} --set KEY=VALUE\n",
        shell_quote(folder.string()));
  }
  return "";
}

std::string text_of(const fs::path& folder, const RunStatus& status) {
  std::string text = fmt::format("{}: {}\n", folder.string(), status_text(status));
  if (status.end) {
    const double fraction = std::floor(100.0 * std::min(1.0, status.time / *status.end));
    text += fmt::format("  {:g} of {:g} s simulated{}{}\n", status.time, *status.end,
                        status.state == "done" ? "" : fmt::format(" ({:.0f} %)", fraction),
                        status.time_left ? fmt::format(", about {} left", duration_text(*status.time_left)) : "");
  } else {
    text += fmt::format("  {:g} s simulated; its end is not known: {}\n", status.time, status.case_error);
  }
  if (!status.history_error.empty()) {
    text += fmt::format("  it may have come further: {}\n", status.history_error);
  }
  if (status.state == "done") {
    return text;
  }
  text += status.checkpoint_age ? fmt::format("  last checkpoint {}\n", age_text(*status.checkpoint_age))
                                : "  no checkpoint yet\n";
  return text + continue_text(folder, status);
}

}  // namespace

int print_status(const std::string& folder, bool json) {
  const RunStatus status = status_of(folder);
  fmt::print("{}", json ? json_text(status) + "\n" : text_of(folder, status));
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app
