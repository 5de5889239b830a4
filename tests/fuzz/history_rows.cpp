// What a checkpoint tells of a history, and the bytes of the file that is there. What a resume makes of it must be
// whole rows, of the header's columns, in the order of time.
#include <fmt/format.h>

#include <sstream>

#include "base/atomic_file.hpp"
#include "changes.hpp"
#include "io/files.hpp"
#include "io/history_writer.hpp"
#include "target.hpp"

namespace {

using namespace thawslide;

const std::string header = "time_s,step,speed_m_s";

std::string sound_rows() {
  std::string text = header + "\n";
  for (int k = 0; k < 12; ++k) {
    text += fmt::format("{},{},{}\n", 0.25 * k, 10 * k, 1.5 - 0.125 * k);
  }
  return text;
}

void require_whole_rows(const std::string& text, std::size_t rows) {
  std::istringstream lines(text);
  std::string line;
  std::size_t found = 0;
  for (bool first = true; std::getline(lines, line); first = false) {
    if (first && line != header) {
      fuzz::fail("another header: " + line);
    }
    found += first ? 0 : 1;
    if (!first && std::count(line.begin(), line.end(), ',') != 2) {
      fuzz::fail("no whole row: " + line);
    }
  }
  if (found != rows || (!text.empty() && text.back() != '\n')) {
    fuzz::fail(fmt::format("{} rows are told, {} are there", rows, found));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  fuzz::Provider bytes(data, size);
  io::HistoryExtent then;
  then.rows = bytes.ConsumeIntegralInRange<std::size_t>(0, 14);
  then.bytes = bytes.ConsumeIntegralInRange<std::size_t>(0, 400);
  then.last_time = 0.25 * bytes.ConsumeIntegralInRange(0, 14);
  const bool is_sound_at_first = bytes.ConsumeBool();
  const std::string text =
      is_sound_at_first ? fuzz::changed(sound_rows(), bytes) : bytes.ConsumeRemainingBytesAsString();
  const std::filesystem::path folder = fuzz::folder() / "run";
  std::filesystem::remove_all(folder);  // with what was kept as damaged
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / "history.csv";
  write_file_atomically(file, text);
  fuzz::gives_value(file, [&] {
    static_cast<void>(io::last_time_in_history(file));
    std::vector<std::string> warnings;
    const auto writer = io::HistoryWriter::continue_after(file, header, then, warnings);
    require_whole_rows(io::read_file(file), writer.extent().rows);
    if (writer.extent().rows != then.rows && warnings.empty()) {
      fuzz::fail("other rows than the checkpoint knew of, and no word of it");
    }
  });
  return 0;
}
