#include "sim/memory_need.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "band/basal_segment.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "sim/maps/flow_maps.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/setup/body_shape.hpp"

namespace thawslide::sim {

namespace {

constexpr double gigabyte = 1e9;

// Horizontal area of positive thickness [m2].
double covered_area(const Raster& thickness) {
  const auto covered =
      std::count_if(thickness.values.begin(), thickness.values.end(), [](double value) { return value > 0.0; });
  return static_cast<double>(covered) * thickness.cell_x * thickness.cell_y;
}

// Columns of nodes across the domain, each with two masses and the marks of its parts.
template <int Dim>
double bytes_of_bed(const config::Grid& grid) {
  double columns = 1.0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    columns *= (grid.max[a] - grid.min[a]) / grid.cell + 1.0;
  }
  return columns * (2.0 * sizeof(double) + sizeof(std::uint16_t));
}

double bytes_of_maps(const config::Case& parameters, const config::Site& site, double area_at_start) {
  const MapGrid grid = map_grid_of(parameters, site);
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  const double passed = std::min(cells, usual_spread * area_at_start / grid.cell_area());
  return passed * static_cast<double>(FlowMaps::bytes_of_cell()) + cells * sizeof(double);
}

std::string parts_of(const MemoryNeed& need) {
  std::string text;
  const auto add = [&](const char* name, double bytes) {
    if (bytes >= 0.01 * need.total()) {
      text += fmt::format("{}{} {} GB", text.empty() ? "" : ", ", name, rounded_text(bytes / gigabyte));
    }
  };
  add("particles", need.particles);
  add("writing them", need.output);
  add("columns of the base", need.columns);
  add("bed", need.bed);
  add("maps", need.maps);
  add("ground", need.ground);
  add("the program", bytes_of_program);
  return text;
}

// Addition to the number of particles in messages.
std::string text_of_splitting(const config::Case& parameters) {
  const double factor = splitting_factor(parameters);
  return factor > 1.0 ? fmt::format(", and about {:g} times as many by mechanics.split_stretched", factor) : "";
}

// Refuses a case that no cell size can make fit, because its cell-independent memory is too large. The message names
// the largest contribution.
[[noreturn]] void refuse_whatever_the_cell(const config::Case& parameters, const BodiesAtStart& bodies,
                                           const MemoryNeed& need, const std::string& amounts) {
  const double fixed = bytes_of_program + need.maps + need.ground;
  if (need.total() > 2.0 * fixed) {
    throw UserError(fmt::format(
        "{}: grid.cell is {} m, which makes {} particles{}: {}. Make grid.cell larger; the rest, {} GB, needs "
        "more memory, or a higher limit of it, whatever the cell.",
        config::location_of(parameters, "grid.cell"), parameters.grid.cell, rounded_text(bodies.particles),
        text_of_splitting(parameters), amounts, rounded_text(fixed / gigabyte)));
  }
  if (bytes_of_program >= std::max(need.maps, need.ground)) {
    throw UserError(fmt::format("{}: {}. The program alone takes {} GB: give it more memory, or a higher limit.",
                                parameters.file, amounts, rounded_text(bytes_of_program / gigabyte)));
  }
  if (need.maps >= need.ground) {
    throw UserError(fmt::format("{}: maps.cell: {}. Make maps.cell larger, or the domain smaller.",
                                config::location_of(parameters, "maps.cell"), amounts));
  }
  throw UserError(
      fmt::format("{}: terrain.file: {}. Make the domain smaller (grid.min, grid.max), or take the DEM to "
                  "points farther apart with terrain.resample.",
                  config::location_of(parameters, "terrain.file"), amounts));
}

}  // namespace

double splitting_factor(const config::Case& parameters) {
  const config::Mechanics& mechanics = parameters.mechanics;
  return mechanics.split_stretched ? std::min(usual_splitting, mechanics.split_limit) : 1.0;
}

template <int Dim>
BodiesAtStart bodies_at_start(const config::Case& parameters, const config::Site& site) {
  BodiesAtStart all;
  for (const auto& [name, body] : parameters.bodies) {
    const double particles_in_volume = std::pow(body.particles_per_axis / parameters.grid.cell, Dim);
    if (body.shape == config::BodyShape::release) {
      const Raster& thickness = site.releases.at(name).thickness;
      all.particles += volume_of(thickness) * particles_in_volume;
      all.area += covered_area(thickness);
      continue;
    }
    const BodyShape<Dim> shape(parameters, site, body, std::nullopt);
    all.particles += shape.volume() * particles_in_volume;
    all.area += (shape.upper(0) - shape.lower(0)) * (Dim == 3 ? shape.upper(1) - shape.lower(1) : 1.0);
  }
  return all;
}

template <int Dim>
MemoryNeed memory_of_particles(double particles) {
  MemoryNeed need;
  need.particles = particles * bytes_of_particle<Dim>;
  need.output = particles * bytes_of_output<Dim>;
  return need;
}

template <int Dim>
MemoryNeed memory_need(const config::Case& parameters, const config::Site& site, const BodiesAtStart& bodies) {
  MemoryNeed need = memory_of_particles<Dim>(bodies.particles * splitting_factor(parameters));
  if (config::has_band_columns(parameters)) {
    const double segments = usual_spread * bodies.area / std::pow(parameters.grid.cell, Dim - 1);
    need.columns = segments * sizeof(band::BasalSegment<Dim>);
  }
  if (parameters.bed.law != config::BedLaw::none) {
    need.bed = bytes_of_bed<Dim>(parameters.grid);
  }
  if constexpr (Dim == 3) {
    need.maps = bytes_of_maps(parameters, site, bodies.area);
  }
  if (site.ground != nullptr) {
    need.ground = bytes_of_map_files + static_cast<double>(site.ground->values.size()) * bytes_of_ground_point;
  }
  return need;
}

template <int Dim>
double smallest_cell(const MemoryNeed& need, double cell, double bytes) {
  const double fixed = bytes_of_program + need.maps + need.ground;
  const double by_volume = need.particles + need.output, by_area = need.columns + need.bed;
  if (!(fixed < bytes)) {
    return 0.0;
  }
  // Memory decreases as cells grow: bisection of the growth factor.
  const auto fits = [&](double factor) {
    return fixed + by_volume / std::pow(factor, Dim) + by_area / std::pow(factor, Dim - 1) <= bytes;
  };
  double low = 0.0, high = 1.0;
  while (!fits(high)) {
    low = high;
    high *= 2.0;
  }
  constexpr int halvings = 60;  // down to round-off
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? high : low) = middle;
  }
  return rounded_up(high * cell, 2);
}

template <int Dim>
const config::Case& require_memory(const config::Case& parameters, const config::Site& site,
                                   const AvailableMemory& available) {
  const BodiesAtStart bodies = bodies_at_start<Dim>(parameters, site);
  const double cell = parameters.grid.cell;
  const MemoryNeed need = memory_need<Dim>(parameters, site, bodies);
  const double smallest = smallest_cell<Dim>(need, cell, available.bytes);
  if (bodies.particles > mpm::most_particles) {
    const double countable = 1.05 * cell * std::pow(bodies.particles / mpm::most_particles, 1.0 / Dim);
    throw UserError(
        fmt::format("{}: grid.cell is {} m, which makes {} particles; allowed: {}. Make grid.cell {:.9g} m or more, or "
                    "particles_per_axis smaller.",
                    config::location_of(parameters, "grid.cell"), cell, rounded_text(bodies.particles),
                    rounded_text(mpm::most_particles), rounded_up(std::max(smallest, countable), 2)));
  }
  if (need.total() <= available.bytes) {
    return parameters;
  }
  const std::string amounts =
      fmt::format("the run needs about {} GB of memory ({}), and {} GB {}", rounded_text(need.total() / gigabyte),
                  parts_of(need), rounded_text(available.bytes / gigabyte), available.bound);
  if (smallest == 0.0) {
    refuse_whatever_the_cell(parameters, bodies, need, amounts);
  }
  throw UserError(fmt::format(
      "{}: grid.cell is {} m, which makes {} particles{}: {}. Make grid.cell {:.9g} m or more, or particles_per_axis "
      "smaller.",
      config::location_of(parameters, "grid.cell"), cell, rounded_text(bodies.particles), text_of_splitting(parameters),
      amounts, smallest));
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                      \
  template BodiesAtStart bodies_at_start<Dim>(const config::Case&, const config::Site&);                \
  template MemoryNeed memory_of_particles<Dim>(double);                                                 \
  template MemoryNeed memory_need<Dim>(const config::Case&, const config::Site&, const BodiesAtStart&); \
  template double smallest_cell<Dim>(const MemoryNeed&, double, double);                                \
  template const config::Case& require_memory<Dim>(const config::Case&, const config::Site&, const AvailableMemory&);
THAWSLIDE_INSTANTIATE(2)
THAWSLIDE_INSTANTIATE(3)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
