#include "io/checkpoint.hpp"

#include <cstring>
#include <numeric>

#include "io/atomic_file.hpp"
#include "io/sha256.hpp"
#include "io/snapshot.hpp"

namespace thawslide::io {

namespace {

constexpr std::uint64_t magic = 0x3144494C53574854;  // "THWSLID1" in bytes
constexpr std::uint64_t format_version = 5;

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

class Reader {
 public:
  Reader(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}
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
    THAWSLIDE_ASSERT(next_ + size <= text_.size(), "{} is whole and yet too short", file_.string());
    std::memcpy(data, text_.data() + next_, size);
    next_ += size;
  }
  void expect(std::uint64_t expected, const char* what) {
    const std::uint64_t found = number();
    if (found != expected) {
      throw UserError(
          fmt::format("{} has {} {}; this run needs {}. Continue it with the case and program that wrote it.",
                      file_.string(), what, found, expected));
    }
  }

 private:
  std::string_view text_;
  std::filesystem::path file_;
  std::size_t next_ = 0;
};

// What is wrong with a checkpoint's bytes; empty: they are what was written.
std::string damage_of(const std::filesystem::path& file, const std::string& bytes) {
  Digest stored{};
  if (bytes.size() > stored.size()) {
    const std::size_t body = bytes.size() - stored.size();
    std::memcpy(stored.data(), bytes.data() + body, stored.size());
    if (sha256(bytes.data(), body) == stored) {
      return "";
    }
  }
  return fmt::format("{} is damaged: its checksum does not fit its {} bytes", file.string(), bytes.size());
}

}  // namespace

WholeCheckpoint newest_checkpoint(const std::filesystem::path& folder) {
  std::string passed_over;
  for (const char* name : {checkpoint_name, previous_checkpoint_name}) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file)) {
      continue;
    }
    std::string bytes = read_file(file);
    const std::string damage = damage_of(file, bytes);
    if (damage.empty()) {
      return {file, std::move(bytes), passed_over};
    }
    passed_over += (passed_over.empty() ? "" : "; ") + damage;
  }
  if (passed_over.empty()) {
    throw UserError(
        fmt::format("{} holds no {} to go on from. A run writes it before its first step, so this is not a run's "
                    "folder, or the run was stopped while it set up. Run the case again.",
                    folder.string(), checkpoint_name));
  }
  throw UserError(passed_over + ". Use another copy, or run the case from its start.");
}

template <int Dim, class Real>
void write_checkpoint(const std::filesystem::path& folder, const mpm::Particles<Dim, Real>& particles,
                      std::size_t at_start, const std::vector<double>& scalars, const NamedNumbers& blocks) {
  Writer writer;
  for (const std::uint64_t number : {magic, format_version, std::uint64_t{Dim}, std::uint64_t{sizeof(Real)},
                                     std::uint64_t{at_start}, std::uint64_t{particles.size()}}) {
    writer.put(number);
  }
  writer.put(scalars);
  const std::vector<std::size_t> order = order_by_id(particles);
  for (const mpm::FieldBase* field : particles.fields.all()) {
    if (field->info().in_checkpoint) {
      const std::vector<std::byte> rows = field->bytes();
      const std::size_t row = rows.size() / std::max<std::size_t>(1, particles.size());
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
  const Digest digest = sha256(writer.text().data(), writer.text().size());
  writer.put_raw(digest.data(), digest.size());
  write_file_atomically(folder / checkpoint_name, writer.text(), folder / previous_checkpoint_name);
}

template <int Dim, class Real>
NamedNumbers read_checkpoint(const WholeCheckpoint& checkpoint, mpm::Particles<Dim, Real>& particles,
                             std::vector<double>& scalars) {
  const std::filesystem::path& file = checkpoint.file;
  Reader reader(std::string_view(checkpoint.bytes).substr(0, checkpoint.bytes.size() - sizeof(Digest)), file);
  reader.expect(magic, "the mark");
  reader.expect(format_version, "format");
  reader.expect(Dim, "dimension");
  reader.expect(sizeof(Real), "number size");
  reader.expect(particles.size(), "particles at t = 0:");
  particles.resize(reader.number());  // some have left since, or joined
  scalars = reader.numbers();
  for (mpm::FieldBase* field : particles.fields.all()) {
    if (field->info().in_checkpoint) {
      const std::string name = reader.text();
      if (name != field->info().name) {
        throw UserError(
            fmt::format("{} has the field '{}' where this program has '{}'. Continue the run with the version "
                        "that wrote it (run.json names it).",
                        file.string(), name, field->info().name));
      }
      std::vector<std::byte> rows(reader.number() * particles.size());
      reader.get_raw(rows.data(), rows.size());
      field->set_bytes(rows);
    }
  }
  NamedNumbers blocks;
  for (std::uint64_t left = reader.number(); left > 0; --left) {
    const std::string name = reader.text();
    blocks[name] = reader.numbers();
  }
  return blocks;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                    \
  template void write_checkpoint<Dim, Real>(const std::filesystem::path&, const mpm::Particles<Dim, Real>&, \
                                            std::size_t, const std::vector<double>&, const NamedNumbers&);  \
  template NamedNumbers read_checkpoint<Dim, Real>(const WholeCheckpoint&, mpm::Particles<Dim, Real>&,      \
                                                   std::vector<double>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::io
