#include "io/hdf5_file.hpp"

#include <cstdlib>
#include <new>

namespace thawslide::io::hdf5 {

namespace {

void require(herr_t result, const char* what) { THAWSLIDE_ASSERT(result >= 0, "HDF5 failed: {}", what); }

// HDF5 crashes if an allocation fails, so the required memory is allocated and released beforehand.
void require_memory(std::size_t bytes) {
  void* volatile memory = std::malloc(bytes);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  std::free(memory);
}

hid_t memory_access(std::size_t bytes) {
  constexpr std::size_t copies = 3, other_bytes = 8'000'000;  // the growing file and its image; other memory
  require_memory(copies * bytes + other_bytes);
  constexpr std::size_t growth = std::size_t{1} << 20;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  require(H5Pset_fapl_core(access, growth, 0), "memory file");
  return access;
}

hid_t timeless_file_creation() {
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  require(H5Pset_obj_track_times(creation, false), "no times");
  return creation;
}

void write_any(hid_t parent, const std::string& name, const Shape& shape, hid_t type, const void* values) {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, "a space");
  const Handle creation = dataset_creation();
  const Handle dataset(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
                       name.c_str());
  require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name.c_str());
}

void write_any_attribute(hid_t object, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         name.c_str());
  require(H5Awrite(attribute, type, values), name.c_str());
}

}  // namespace

MemoryFile::MemoryFile(std::size_t bytes)
    : access_(memory_access(bytes), H5Pclose, "access"),
      creation_(timeless_file_creation(), H5Pclose, "creation"),
      file_(H5Fcreate("in-memory.h5", H5F_ACC_TRUNC, creation_, access_), H5Fclose, "a file in memory") {}

std::vector<std::byte> MemoryFile::bytes() const {
  require(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush");
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  THAWSLIDE_ASSERT(size > 0, "HDF5 file image of {} bytes", size);
  std::vector<std::byte> image(static_cast<std::size_t>(size));
  THAWSLIDE_ASSERT(H5Fget_file_image(file_, image.data(), image.size()) == size, "HDF5 file image changed size");
  return image;
}

Handle dataset_creation() {
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  require(H5Pset_obj_track_times(creation, false), "no times");
  return {creation, H5Pclose, "dataset creation"};
}

Handle make_group(hid_t parent, const std::string& name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "group creation");
  require(H5Pset_obj_track_times(creation, false), "no times");
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, name.c_str()};
}

void write_dataset(hid_t parent, const std::string& name, const Shape& shape, const double* values) {
  write_any(parent, name, shape, H5T_NATIVE_DOUBLE, values);
}

void write_dataset(hid_t parent, const std::string& name, const Shape& shape, const std::int64_t* values) {
  write_any(parent, name, shape, H5T_NATIVE_INT64, values);
}

void write_attribute(hid_t object, const std::string& name, double value) {
  write_any_attribute(object, name, H5T_NATIVE_DOUBLE, Handle(H5Screate(H5S_SCALAR), H5Sclose, "a scalar"), &value);
}

void write_attribute(hid_t object, const std::string& name, std::int64_t value) {
  write_any_attribute(object, name, H5T_NATIVE_INT64, Handle(H5Screate(H5S_SCALAR), H5Sclose, "a scalar"), &value);
}

void write_attribute(hid_t object, const std::string& name, const std::vector<std::int64_t>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "a space");
  write_any_attribute(object, name, H5T_NATIVE_INT64, space, values.data());
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a text type");
  require(H5Tset_size(type, text.size()), "text length");
  require(H5Tset_strpad(type, H5T_STR_NULLPAD), "text padding");
  write_any_attribute(object, name, type, Handle(H5Screate(H5S_SCALAR), H5Sclose, "a scalar"), text.data());
}

Handle make_vtk_root(hid_t file) {
  Handle root = make_group(file, "VTKHDF");
  write_attribute(root, "Version", std::vector<std::int64_t>{2, 0});
  write_attribute(root, "Type", std::string("PolyData"));
  return root;
}

}  // namespace thawslide::io::hdf5
