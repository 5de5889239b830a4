// Parts of the extension module thawslide._core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace thawslide::python {

// Input files of cases, and readers of the rasters and polygons of a user, which Python opens by no other means.
void bind_files(nanobind::module_& module);

template <class T>
nanobind::object copied(const std::vector<T>& values, std::initializer_list<std::size_t> shape) {
  auto* copy = new T[values.size()];
  const nanobind::capsule owner(copy, [](void* memory) noexcept { delete[] static_cast<T*>(memory); });
  std::copy(values.begin(), values.end(), copy);
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(copy, shape, owner));
}

}  // namespace thawslide::python
