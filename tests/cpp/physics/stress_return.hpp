// Return of trial stresses to the yield surface by each executor.
#pragma once

#include <algorithm>
#include <vector>

#include "base/simd.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::physics {

enum class Executor { device, cpu };  // a device computes single numbers, the CPU lanes

// Results for stresses after a plastic strain. On the CPU, consecutive stresses share a batch.
template <int Dim, class Law>
std::vector<ReturnResult<double>> returned_by(Executor executor, const Law& law,
                                              const std::vector<SymmetricTensor<double>>& trials,
                                              double plastic_strain = 0.0) {
  using Lanes = Simd<double>;
  std::vector<ReturnResult<double>> results;
  while (results.size() < trials.size()) {
    if (executor == Executor::device) {
      results.push_back(law.template update<Dim>(trials[results.size()], plastic_strain));
      continue;
    }
    SymmetricTensor<Lanes> trial;
    for (int c = 0; c < 6; ++c) {
      trial[c] =
          Lanes::of([&](std::size_t lane) { return trials[std::min(results.size() + lane, trials.size() - 1)][c]; });
    }
    const auto batch = law.template update<Dim>(trial, Lanes(plastic_strain));
    for (std::size_t lane = 0; lane < Lanes::count && results.size() < trials.size(); ++lane) {
      ReturnResult<double> result{trials[results.size()]};
      for (int c = 0; c < 6; ++c) {
        result.stress[c] = batch.stress[c][lane];
      }
      result.equivalent_plastic_strain_increment = batch.equivalent_plastic_strain_increment[lane];
      result.plastic_work_density = batch.plastic_work_density[lane];
      result.opening = batch.opening[lane];
      result.yielded = batch.yielded[lane];
      results.push_back(result);
    }
  }
  return results;
}

}  // namespace thawslide::physics
