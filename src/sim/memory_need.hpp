// Whether the particles of a case fit into memory, told before they are made.
#pragma once

#include "config/case.hpp"

namespace thawslide::sim {

// Heap in use over particles after a run of 100,000, with grid and nodes [bytes]; measured by benchmarks/speed
// (docs/performance.md). Thin slides take more a particle, compact ones less.
template <int Dim>
inline constexpr double bytes_of_particle = Dim == 3 ? 640.0 : 616.0;

// Bytes that this process may use: the machine's memory, or less where a limit is set (ulimit -v).
[[nodiscard]] double memory_allowed();

// The smallest grid.cell [m], in two digits, whose particles fit into so many bytes; `filled`: sum over the bodies of
// volume [m3] times the number of particles in a cell.
template <int Dim>
[[nodiscard]] double smallest_cell(double filled, double bytes);

// Throws UserError where the particles need more than memory_allowed.
template <int Dim>
void require_memory(const config::Case& parameters, double filled);

}  // namespace thawslide::sim
