// Estimate of the memory of a run, made before any allocation.
#pragma once

#include <cstddef>

#include "base/available_memory.hpp"
#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Heap memory divided by particles after a run of 100,000, with grid and nodes [bytes]; measured by benchmarks/speed
// (benchmarks/README.md). Thin slides need more per particle, compact ones less.
template <int Dim>
inline constexpr double bytes_of_particle = Dim == 3 ? 655.0 : 631.0;

// Additional memory per particle while a snapshot or a checkpoint is assembled [bytes]: peak of runs of 340,000 (2D)
// and 420,000 (3D) particles, minus the value above.
template <int Dim>
inline constexpr double bytes_of_output = Dim == 3 ? 930.0 : 800.0;

// Memory per point of the ground raster, in the site and in the surface [bytes]: measured for 45 million points.
inline constexpr double bytes_of_ground_point = 16.0;

// Memory of the program and its libraries, and of reading and writing maps [bytes]: peak of small runs, minus the
// values above.
inline constexpr double bytes_of_program = 60e6, bytes_of_map_files = 100e6;

// Ratio of the area that a moving slide covers, now and before, to its initial area: an allowance.
inline constexpr double usual_spread = 5.0;

// Number of particles relative to t = 0 if stretched ones are split (mechanics.split_stretched), an allowance: 1.3 to
// 5.9 times in whole runs (plane, Lamplugh, slope of the Alps). Also the cost of such a run over one that splits none:
// 1.1 to 1.5 times.
inline constexpr double usual_splitting = 6.0, usual_cost_of_splitting = 1.5;

// Memory in bytes.
struct MemoryNeed {
  double particles = 0.0;  // with the surrounding grid
  double output = 0.0;     // while a snapshot or a checkpoint is written
  double columns = 0.0;    // of the band
  double bed = 0.0;        // erodible
  double maps = 0.0;       // cells that the slide passes, and one map being written
  double ground = 0.0;     // of a DEM

  [[nodiscard]] double total() const { return bytes_of_program + particles + output + columns + bed + maps + ground; }
};

// Initial extent of the bodies.
struct BodiesAtStart {
  double particles = 0.0;  // approximate number
  double area = 0.0;       // horizontal [m2], per metre of width in 2D
};

// Number of particles of a run relative to t = 0: 1 unless it splits them.
[[nodiscard]] double splitting_factor(const config::Case& parameters);

template <int Dim>
[[nodiscard]] BodiesAtStart bodies_at_start(const config::Case& parameters, const config::Site& site);

// Memory of particles alone, independent of their positions.
template <int Dim>
[[nodiscard]] MemoryNeed memory_of_particles(double particles);

template <int Dim>
[[nodiscard]] MemoryNeed memory_need(const config::Case& parameters, const config::Site& site,
                                     const BodiesAtStart& bodies);

// Smallest grid.cell [m], with two digits, for which a run fits into `bytes`; need: with cells of `cell` [m]. Returns 0
// if there is none, because maps and ground alone exceed the limit.
template <int Dim>
[[nodiscard]] double smallest_cell(const MemoryNeed& need, double cell, double bytes);

// Throws UserError if a run needs more memory than available, or has more particles than the index limit; returns the
// case.
template <int Dim>
const config::Case& require_memory(const config::Case& parameters, const config::Site& site,
                                   const AvailableMemory& available = available_memory());

}  // namespace thawslide::sim
