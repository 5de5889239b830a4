// VTKHDF format (version 2, PolyData): parts shared by snapshots and their index.
#pragma once

#include "io/hdf5_file.hpp"

namespace thawslide::io::vtkhdf {

inline constexpr const char* cell_kinds[] = {"Vertices", "Lines", "Polygons", "Strips"};

inline hdf5::Handle make_root(hid_t file) {
  hdf5::Handle root = hdf5::make_group(file, "VTKHDF");
  hdf5::write_attribute(root, "Version", std::vector<std::int64_t>{2, 0});
  hdf5::write_attribute(root, "Type", std::string("PolyData"));
  return root;
}

}  // namespace thawslide::io::vtkhdf
