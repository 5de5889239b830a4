// A thin hold on the HDF5 library: handles that close themselves, files in memory, no times stored, so that the same
// content gives the same bytes.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace thawslide::io::hdf5 {

// Closes with the function that belongs to its kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    THAWSLIDE_ASSERT(id >= 0, "HDF5 could not make {}", what);
  }
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  operator hid_t() const { return id_; }  // NOLINT: stands for the library's own handle everywhere

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// While it lives, the library does not print what goes wrong: of a file that may be damaged the caller tells.
class Silence {
 public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

using Shape = std::vector<hsize_t>;

// A file in memory.
class MemoryFile {
 public:
  // bytes: as much is written to it, about. Throws bad_alloc where there is no room for that.
  explicit MemoryFile(std::size_t bytes = 0);
  [[nodiscard]] hid_t root() const { return file_; }
  // The file's bytes, as they would stand on disk.
  [[nodiscard]] std::vector<std::byte> bytes() const;

 private:
  Handle access_, creation_, file_;
};

Handle make_group(hid_t parent, const std::string& name);
void write_dataset(hid_t parent, const std::string& name, const Shape& shape, const double* values);
void write_dataset(hid_t parent, const std::string& name, const Shape& shape, const std::int64_t* values);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const std::string& name, const std::vector<std::int64_t>& values);
// A text of fixed length, as VTK asks for.
void write_attribute(hid_t object, const std::string& name, const std::string& text);

// Creation properties of a dataset that stores no times.
Handle dataset_creation();

}  // namespace thawslide::io::hdf5
