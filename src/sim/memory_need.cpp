#include "sim/memory_need.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace thawslide::sim {

double memory_allowed() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return bytes;
}

template <int Dim>
double smallest_cell(double filled, double bytes) {
  const double cell = std::pow(filled * bytes_of_particle<Dim> / bytes, 1.0 / Dim);
  const double digit = std::pow(10.0, std::floor(std::log10(cell)) - 1.0);
  return std::ceil(cell / digit * (1.0 - 1e-12)) * digit;
}

template <int Dim>
void require_memory(const config::Case& parameters, double filled) {
  const double particles = filled / std::pow(parameters.grid.cell, Dim);
  const double needed = particles * bytes_of_particle<Dim>, allowed = memory_allowed();
  if (needed > allowed) {
    throw UserError(fmt::format(
        "{}: grid.cell is {} m, which makes {:.3g} particles; they need about {:.3g} GB of memory, and there are "
        "{:.3g} GB. Make grid.cell {:g} m or more, or particles_per_axis smaller.",
        config::place_of(parameters, "grid.cell"), parameters.grid.cell, particles, needed / 1e9, allowed / 1e9,
        smallest_cell<Dim>(filled, allowed)));
  }
}

template double smallest_cell<2>(double, double);
template double smallest_cell<3>(double, double);
template void require_memory<2>(const config::Case&, double);
template void require_memory<3>(const config::Case&, double);

}  // namespace thawslide::sim
