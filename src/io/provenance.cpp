#include "io/provenance.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "io/files.hpp"
#include "version.hpp"

namespace thawslide::io {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

namespace {

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

std::string now_utc() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

// Calls work(key of run.json, member) for the members of a part.
template <class Part, class Work>
void for_each_member(Part& part, const Work& work) {
  work("version", part.version);
  work("commit", part.commit);
  work("command", part.command);
  work("host", part.host);
  work("processor", part.processor);
  work("threads", part.threads);
  work("device", part.device);
  work("started", part.started);
  work("from_s", part.from_time);
  work("changes", part.changes);
  work("warnings", part.warnings);
  work("case_sha256", part.case_sha256);
  work("wall_s", part.wall_seconds);
  work("particle_steps", part.particle_steps);
}

OrderedJson json_of(const RunPart& part) {
  OrderedJson json;
  for_each_member(part, [&](const char* key, const auto& value) { json[key] = value; });
  return json;
}

RunPart part_of(const OrderedJson& json) {
  RunPart part;
  for_each_member(part, [&](const std::string& key, auto& value) {
    if (json.contains(key) || (key != "device" && key != "warnings")) {  // older runs lack these two
      json.at(key).get_to(value);
    }
  });
  return part;
}

[[noreturn]] void fail_as_damaged(const fs::path& file, const std::string& what) {
  throw UserError(
      "{} is damaged: {}. Without it, the run cannot continue. Put back a copy of it, or run the case again into "
      "another folder: thawslide run {} --output OTHER.",
      file.string(), what, shell_quote(file.parent_path().string()));
}

}  // namespace

RunPart part_of_this_process() { return {version, commit, command_line(), host_name(), processor_name(), now_utc()}; }

void write_provenance(const fs::path& file, const Provenance& p) {
  THAWSLIDE_ASSERT(!p.parts.empty(), "{} of a run without parts", file.string());
  double wall = 0.0, particle_steps = 0.0;
  OrderedJson parts = OrderedJson::array();
  for (const RunPart& part : p.parts) {
    wall += part.wall_seconds;
    particle_steps += part.particle_steps;
    parts.push_back(json_of(part));
  }
  OrderedJson json;
  json["program"] = "thawslide";
  for (const char* key : {"version", "commit", "command", "host", "processor", "threads", "started"}) {
    json[key] = parts.front()[key];
  }
  json["status"] = p.status;
  json["message"] = p.message;
  json["simulated_time_s"] = p.simulated_time;
  json["steps"] = p.steps;
  json["at_rest"] = p.at_rest ? OrderedJson(*p.at_rest) : OrderedJson();
  json["warnings"] = p.warnings;
  json["particles"] = p.particles;
  for (const auto& [cause, count] : p.removed) {
    json["removed_particles"][cause] = count;
  }
  json["wall_s"] = wall;
  json["particle_steps_per_second"] = wall > 0.0 ? particle_steps / wall : 0.0;
  json["parts"] = std::move(parts);
  json["seconds_per_stage"] = p.seconds_per_stage;
  json["writer_seconds"] = p.writer_seconds;
  json["origin_m"] = p.origin;
  json["gravity_m_s2"] = p.gravity;
  json["crs"] = p.crs.empty() ? OrderedJson() : OrderedJson(p.crs);
  json["roughness"] = OrderedJson();
  for (const auto& [name, value] : p.roughness) {
    json["roughness"][name] = value;
  }
  for (const auto& [name, value] : p.figures) {
    json[name] = std::isfinite(value) ? OrderedJson(value) : OrderedJson();
  }
  json["inputs"] = OrderedJson::array();
  for (const InputFile& input : p.inputs) {
    json["inputs"].push_back(
        {{"path", input.path}, {"copy", input.copy}, {"sha256", input.sha256}, {"bytes", input.bytes}});
  }
  json["cite"] = "Thawslide (CITATION.cff), and the paper whose model it implements (docs/theory.md)";
  write_file_atomically(file, json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
}

std::vector<InputFile> copy_inputs(const fs::path& folder, const std::vector<fs::path>& files,
                                   const std::map<fs::path, std::string>& texts) {
  make_folder(folder / "inputs");
  std::vector<InputFile> inputs;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    if (is_unfinished(file)) {
      throw UserError(
          "{} has a name that the program gives to files while it writes them, and that it removes. Give the file "
          "another name.",
          file.string());
    }
    THAWSLIDE_ASSERT(names.insert(name).second, "two inputs are called {}, which run::input_files refuses", name);
    const auto known = texts.find(file);
    const std::string content = known == texts.end() ? read_file(file) : known->second;
    write_file_atomically(folder / "inputs" / name, content);
    inputs.push_back({file.string(), "inputs/" + name, sha256_hex(content), content.size()});
  }
  return inputs;
}

Provenance read_provenance(const fs::path& folder) {
  Provenance provenance;
  const fs::path file = folder / "run.json";
  const std::string text = read_file(file);
  try {
    const OrderedJson facts = OrderedJson::parse(text);
    for (const OrderedJson& part : facts.at("parts")) {
      provenance.parts.push_back(part_of(part));
    }
    for (const OrderedJson& input : facts.at("inputs")) {
      provenance.inputs.push_back({input.at("path"), input.at("copy"), input.at("sha256"), input.at("bytes")});
    }
    provenance.status = facts.at("status");
    provenance.message = facts.at("message");
    provenance.simulated_time = facts.at("simulated_time_s");
    provenance.steps = facts.at("steps");
  } catch (const OrderedJson::parse_error& error) {
    fail_as_damaged(file, text.empty() ? "it is empty" : fmt::format("it is not JSON from byte {} on", error.byte));
  } catch (const OrderedJson::exception& error) {
    const std::string specified = error.what();
    fail_as_damaged(
        file, specified.substr(std::min(specified.size(), specified.find("] ") + 2)));  // without the library's number
  }
  if (provenance.parts.empty()) {
    fail_as_damaged(file, "it lists no parts of the run");
  }
  return provenance;
}

std::string sha256_of_file(const fs::path& file) { return sha256_hex(read_file(file)); }

}  // namespace thawslide::io
