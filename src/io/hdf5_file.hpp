// HDF5: handles with automatic closing, files in memory. Without time stamps: the same content gives the same bytes.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace thawslide::io::hdf5 {

// Handle that is closed with the function of its kind.
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

using Shape = std::vector<hsize_t>;

// A file in memory.
class MemoryFile {
 public:
  // bytes: approximate size of its content. Throws bad_alloc if memory is insufficient.
  explicit MemoryFile(std::size_t bytes = 0);
  [[nodiscard]] hid_t root() const { return file_; }
  // Bytes of the file as on disk.
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
// Text of fixed length, as required by VTK.
void write_attribute(hid_t object, const std::string& name, const std::string& text);

// Creation properties of a dataset without time stamps.
Handle dataset_creation();

// Kinds of cells of VTKHDF files (version 2, PolyData), and their root group: shared by snapshots and their index.
inline constexpr const char* cell_kinds[] = {"Vertices", "Lines", "Polygons", "Strips"};
Handle make_vtk_root(hid_t file);

}  // namespace thawslide::io::hdf5
