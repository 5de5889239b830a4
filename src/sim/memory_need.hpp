// How much memory a run will take, told before anything of it is made.
#pragma once

#include <cstddef>

#include "base/available_memory.hpp"
#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Heap in use over particles after a run of 100,000, with grid and nodes [bytes]; measured by benchmarks/speed
// (docs/performance.md). Thin slides take more a particle, compact ones less.
template <int Dim>
inline constexpr double bytes_of_particle = Dim == 3 ? 655.0 : 631.0;

// What a particle takes besides while a snapshot or a checkpoint of it is put together [bytes]: measured as the peak of
// runs of 340,000 (2D) and 420,000 (3D), less the above.
template <int Dim>
inline constexpr double bytes_of_output = Dim == 3 ? 930.0 : 800.0;

// A point of the ground's raster, in the site and in the surface [bytes]: measured over 45 million.
inline constexpr double bytes_of_ground_point = 16.0;

// The program and its libraries, and what those take that read and write maps [bytes]: measured as the peak of small
// runs, less the above.
inline constexpr double bytes_of_program = 60e6, bytes_of_map_files = 100e6;

// A slide on its way covers, and has been on, more ground than it starts from: an allowance.
inline constexpr double usual_spread = 5.0;

// As far as a field's places can be counted: an affine velocity has nine numbers.
inline constexpr double most_particles = 2.3e8;

// [bytes]
struct MemoryNeed {
  double particles = 0.0;  // with the grid about them
  double output = 0.0;     // while a snapshot or a checkpoint is written
  double columns = 0.0;    // below the base
  double bed = 0.0;        // that is erodible
  double maps = 0.0;       // what the slide passes of them, and one that is written
  double ground = 0.0;     // of a DEM

  [[nodiscard]] double total() const { return bytes_of_program + particles + output + columns + bed + maps + ground; }
};

// What the bodies fill at the start.
struct BodiesAtStart {
  double particles = 0.0;  // about as many
  double area = 0.0;       // horizontal [m2], per metre of width in 2D
};

template <int Dim>
[[nodiscard]] BodiesAtStart bodies_at_start(const config::Case& parameters, const config::Site& site);

// Of particles alone, wherever they are.
template <int Dim>
[[nodiscard]] MemoryNeed memory_of_particles(double particles);

template <int Dim>
[[nodiscard]] MemoryNeed memory_need(const config::Case& parameters, const config::Site& site,
                                     const BodiesAtStart& bodies);

// The smallest grid.cell [m], in two digits, with which a run fits into so many bytes that needs this with cells of
// `cell` [m]; 0 where none does, as maps and ground alone take more.
template <int Dim>
[[nodiscard]] double smallest_cell(const MemoryNeed& need, double cell, double bytes);

// Throws UserError where a run needs more than is available, or has more particles than can be counted; returns the
// case.
template <int Dim>
const config::Case& require_memory(const config::Case& parameters, const config::Site& site,
                                   const AvailableMemory& available = available_memory());

}  // namespace thawslide::sim
