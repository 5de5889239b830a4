#include "io/checkpoint.hpp"

#include <cstring>

#include "base/atomic_file.hpp"
#include "config/input_limits.hpp"
#include "io/files.hpp"
#include "io/snapshot.hpp"

namespace thawslide::io {

namespace {

constexpr std::uint64_t magic = 0x3144494C53574854;  // "THWSLID1" as bytes
constexpr std::uint64_t format_version = 15;

class Writer {
 public:
  void put(std::uint64_t number) { put_raw(&number, sizeof number); }
  void put(const std::string& text) {
    put(text.size());
    put_raw(text.data(), text.size());
  }
  void put(const std::vector<double>& numbers) {
    put(numbers.size());
    put_raw(numbers.data(), numbers.size() * sizeof(double));
  }
  void put_raw(const void* data, std::size_t size) { text_.append(static_cast<const char*>(data), size); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Parser of a checkpoint whose checksum fits.
class Reader {
 public:
  Reader(std::string_view text, const std::filesystem::path& file) : left_(text), file_(file) {}
  std::uint64_t number() {
    std::uint64_t value = 0;
    get_raw(&value, sizeof value);
    return value;
  }
  std::string text() {
    std::string value(number(), '\0');
    get_raw(value.data(), value.size());
    return value;
  }
  std::vector<double> numbers() {
    std::vector<double> values(number());
    get_raw(values.data(), values.size() * sizeof(double));
    return values;
  }
  void get_raw(void* data, std::size_t size) {
    THAWSLIDE_ASSERT(size <= left_.size(), "{} bytes are left of {}, {} needed", left_.size(), file_.string(), size);
    if (size > 0) {
      std::memcpy(data, left_.data(), size);
      left_.remove_prefix(size);
    }
  }
  void expect(std::uint64_t expected, const char* what) {
    const std::uint64_t found = number();
    if (found != expected) {
      throw UserError("{} has {} {}; this run needs {}. Continue it with the case and program that wrote it.",
                      file_.string(), what, found, expected);
    }
  }

 private:
  std::string_view left_;
  std::filesystem::path file_;
};

// Description of the damage in a checkpoint's bytes; empty if they are as written.
std::string damage_of(const std::filesystem::path& file, const std::string& bytes) {
  Digest stored{};
  if (bytes.size() > stored.size()) {
    const std::size_t body = bytes.size() - stored.size();
    std::memcpy(stored.data(), bytes.data() + body, stored.size());
    if (sha256(std::string_view(bytes).substr(0, body)) == stored) {
      return "";
    }
  }
  return fmt::format("{} is damaged: its checksum does not fit its {} bytes", file.string(), bytes.size());
}

// True if the name exists, including a dangling link.
bool is_present(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::exists(std::filesystem::symlink_status(file, unknown));
}

// Reads a checkpoint. Returns the problem, empty if the file is intact; an unreadable file counts as damaged.
std::string fault_of(const std::filesystem::path& file, std::string& bytes) {
  if (const std::string found = config::other_kind_of_file(file); !found.empty()) {
    return fmt::format("{} is {}, no file", file.string(), found);
  }
  try {
    bytes = read_file(file);
  } catch (const UserError& error) {
    return error.what();
  }
  return damage_of(file, bytes);
}

// Reader positioned at the case text.
Reader reader_of(const WholeCheckpoint& checkpoint) {
  Reader reader(std::string_view(checkpoint.bytes).substr(0, checkpoint.bytes.size() - sizeof(Digest)),
                checkpoint.file);
  reader.expect(magic, "the mark");
  reader.expect(format_version, "format");
  return reader;
}

void read_field(Reader& reader, const std::filesystem::path& file, std::size_t particles, mpm::FieldBase& field) {
  const std::string name = reader.text();
  if (name != field.info().name) {
    throw UserError(
        "{} has the field '{}' where this program has '{}'. Continue the run with the version that wrote it (run.json "
        "names it).",
        file.string(), config::shown(name), field.info().name);
  }
  const std::size_t row_bytes = field.components() * field.number_bytes();
  reader.expect(row_bytes, fmt::format("bytes a particle of the field '{}':", name).c_str());
  std::vector<std::byte> rows(row_bytes * particles);
  reader.get_raw(rows.data(), rows.size());
  field.set_bytes(rows);
}

}  // namespace

WholeCheckpoint intact_checkpoint(const std::filesystem::path& file, const std::string& bytes) {
  if (const std::string damage = damage_of(file, bytes); !damage.empty()) {
    throw UserError(damage + ". Use the bytes that `checkpoint` returned.");
  }
  return {file, bytes, ""};
}

bool has_checkpoint(const std::filesystem::path& folder) {
  return is_present(folder / checkpoint_name) || is_present(folder / previous_checkpoint_name);
}

std::string case_of(const WholeCheckpoint& checkpoint) { return reader_of(checkpoint).text(); }

WholeCheckpoint newest_checkpoint(const std::filesystem::path& folder) {
  if (!has_checkpoint(folder)) {
    throw UserError(
        "{} holds no {} to continue from. A run writes it before its first step: this is not the folder of a run, or "
        "the run was stopped during its setup. Run the case again.",
        folder.string(), checkpoint_name);
  }
  WholeCheckpoint found;
  for (const char* name : {checkpoint_name, previous_checkpoint_name}) {
    found.file = folder / name;
    const bool has_name = is_present(found.file);
    const std::string fault = has_name ? fault_of(found.file, found.bytes) : found.file.string() + " is missing";
    if (fault.empty()) {
      return found;
    }
    found.warning += (found.warning.empty() ? "" : "; ") + fault;
    found.damaged = has_name ? found.file : std::filesystem::path();
  }
  throw UserError(found.warning + ". Use another copy, or run the case from its start.");
}

template <int Dim>
std::string checkpoint_bytes(const mpm::Particles<Dim>& particles, std::size_t at_start,
                             const std::vector<double>& scalars, const NamedNumbers& blocks,
                             const std::string& case_text) {
  Writer writer;
  writer.put(magic);
  writer.put(format_version);
  writer.put(case_text);
  for (const std::uint64_t number :
       {std::uint64_t{Dim}, std::uint64_t{sizeof(double)}, std::uint64_t{at_start}, std::uint64_t{particles.size()}}) {
    writer.put(number);
  }
  writer.put(scalars);
  const std::vector<std::size_t> order = order_by_id(particles);
  for (const mpm::FieldBase* field : particles.fields.all()) {
    if (field->info().in_checkpoint) {
      const std::vector<std::byte> rows = field->bytes();
      const std::size_t row = field->components() * field->number_bytes();
      writer.put(field->info().name);
      writer.put(row);
      for (const std::size_t p : order) {
        writer.put_raw(rows.data() + p * row, row);
      }
    }
  }
  writer.put(blocks.size());
  for (const auto& [name, numbers] : blocks) {
    writer.put(name);
    writer.put(numbers);
  }
  const Digest digest = sha256(writer.text());
  writer.put_raw(digest.data(), digest.size());
  return writer.text();
}

template <int Dim>
void write_checkpoint(const std::filesystem::path& folder, const mpm::Particles<Dim>& particles, std::size_t at_start,
                      const std::vector<double>& scalars, const NamedNumbers& blocks, const std::string& case_text) {
  write_file_atomically(folder / checkpoint_name,
                        checkpoint_bytes<Dim>(particles, at_start, scalars, blocks, case_text),
                        folder / previous_checkpoint_name);
}

template <int Dim>
NamedNumbers read_checkpoint(const WholeCheckpoint& checkpoint, mpm::Particles<Dim>& particles,
                             std::vector<double>& scalars) {
  const std::filesystem::path& file = checkpoint.file;
  Reader reader = reader_of(checkpoint);
  (void)reader.text();  // skips the case
  reader.expect(Dim, "dimension");
  reader.expect(sizeof(double), "number size");
  reader.expect(particles.size(), "particles at t = 0:");
  // The number of particles may have changed, by removal, entrainment or splitting.
  particles.resize(reader.number());
  scalars = reader.numbers();
  for (mpm::FieldBase* field : particles.fields.all()) {
    if (field->info().in_checkpoint) {
      read_field(reader, file, particles.size(), *field);
    }
  }
  NamedNumbers blocks;
  for (std::uint64_t left = reader.number(); left > 0; --left) {
    const std::string name = reader.text();
    blocks.emplace(name, reader.numbers());
  }
  return blocks;
}

template <int Dim>
std::size_t checkpoint_bytes_of_particle() {
  const mpm::Particles<Dim> any;
  std::size_t bytes = 0;
  for (const mpm::FieldBase* field : any.fields.all()) {
    bytes += field->info().in_checkpoint ? field->components() * field->number_bytes() : 0;
  }
  return bytes;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                \
  template std::size_t checkpoint_bytes_of_particle<Dim>();                                                       \
  template std::string checkpoint_bytes<Dim>(const mpm::Particles<Dim>&, std::size_t, const std::vector<double>&, \
                                             const NamedNumbers&, const std::string&);                            \
  template void write_checkpoint<Dim>(const std::filesystem::path&, const mpm::Particles<Dim>&, std::size_t,      \
                                      const std::vector<double>&, const NamedNumbers&, const std::string&);       \
  template NamedNumbers read_checkpoint<Dim>(const WholeCheckpoint&, mpm::Particles<Dim>&, std::vector<double>&);
THAWSLIDE_INSTANTIATE(2)
THAWSLIDE_INSTANTIATE(3)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::io
