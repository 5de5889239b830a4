// Checkpoint state of the band columns in host memory.
#pragma once

#include <vector>

#include "band/basal_segments.hpp"
#include "exec/cpu.hpp"

namespace thawslide::band {

template <int Dim>
using BaseColumns = BasalSegments<exec::Cpu, Dim>;

// Without the time since the columns' last step. restore throws UserError for an impossible state.
template <int Dim>
[[nodiscard]] std::vector<double> numbers_of(const BaseColumns<Dim>& columns);
template <int Dim>
void restore(const std::vector<double>& numbers, BaseColumns<Dim>& columns);

}  // namespace thawslide::band
