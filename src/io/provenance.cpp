#include "io/provenance.hpp"

#include <unistd.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "io/atomic_file.hpp"
#include "io/sha256.hpp"
#include "version.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::uintmax_t linked_from = 50'000'000;  // bytes

std::string host_name() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown";
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline");
  std::string text;
  for (std::string word; std::getline(file, word, '\0');) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

Provenance provenance_of_this_program() {
  Provenance provenance;
  provenance.version = version;
  provenance.commit = commit;
  provenance.command = command_line();
  provenance.host = host_name();
  provenance.processor = processor_name();
  provenance.started = now_utc();
  return provenance;
}

void write_provenance(const fs::path& file, const Provenance& p) {
  Json json;
  json["program"] = "thawslide";
  json["version"] = p.version;
  json["commit"] = p.commit;
  json["command"] = p.command;
  json["host"] = p.host;
  json["processor"] = p.processor;
  json["threads"] = p.threads;
  json["started"] = p.started;
  json["status"] = p.status;
  json["message"] = p.message;
  json["simulated_time_s"] = p.simulated_time;
  json["steps"] = p.steps;
  json["particles"] = p.particles;
  for (const auto& [cause, count] : p.removed) {
    json["removed_particles"][cause] = count;
  }
  json["wall_s"] = p.wall_seconds;
  json["particle_steps_per_second"] = p.wall_seconds > 0.0 ? p.particle_steps / p.wall_seconds : 0.0;
  json["seconds_per_stage"] = p.seconds_per_stage;
  json["seconds_beside"] = p.seconds_beside;
  json["origin_m"] = p.origin;
  json["gravity_m_s2"] = p.gravity;
  json["crs"] = p.crs.empty() ? Json() : Json(p.crs);
  for (const auto& [name, value] : p.figures) {
    json[name] = std::isfinite(value) ? Json(value) : Json();
  }
  json["inputs"] = Json::array();
  for (const InputFile& input : p.inputs) {
    json["inputs"].push_back(
        {{"path", input.path}, {"copy", input.copy}, {"sha256", input.sha256}, {"bytes", input.bytes}});
  }
  json["cite"] = "Thawslide (CITATION.cff), and the paper whose model it implements (docs/theory.md)";
  write_file_atomically(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<InputFile> copy_inputs(const fs::path& folder, const std::vector<fs::path>& files) {
  fs::create_directories(folder / "inputs");
  std::vector<InputFile> inputs;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    if (!names.insert(name).second) {
      throw UserError(
          fmt::format("two inputs are called {}; rename one: a run keeps copies of both in one folder", name));
    }
    const std::string content = read_file(file);
    const fs::path copy = folder / "inputs" / name;
    // A large file is linked, which takes no room, where the file system can: the run goes on from it all the same.
    std::error_code not_linked;
    if (content.size() > linked_from) {
      fs::create_hard_link(file, copy, not_linked);
    }
    if (content.size() <= linked_from || not_linked) {
      write_file_atomically(copy, content);
    }
    inputs.push_back({file.string(), "inputs/" + name, sha256_hex(content.data(), content.size()), content.size()});
  }
  return inputs;
}

std::vector<InputFile> read_inputs(const fs::path& folder) {
  std::vector<InputFile> inputs;
  try {
    const Json facts = Json::parse(read_file(folder / "run.json"));
    for (const Json& input : facts.at("inputs")) {
      inputs.push_back({input.at("path"), input.at("copy"), input.at("sha256"), input.at("bytes")});
    }
  } catch (const Json::exception& error) {
    throw UserError(fmt::format("{} cannot be understood: {}", (folder / "run.json").string(), error.what()));
  }
  return inputs;
}

}  // namespace thawslide::io
