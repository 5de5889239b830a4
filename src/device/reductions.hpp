// Reductions over all particles: kernels (mpm/kernel.hpp).
#pragma once

#include "band/body_sums.hpp"
#include "band/step_extremes.hpp"
#include "mpm/kernel.hpp"
#include "mpm/monitor_sums.hpp"

namespace thawslide::device {

// Sums for the run monitor (failure checks, rest).
template <int Dim>
struct RunMonitor {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::MonitorSums;

  mpm::MonitorKernel<Dim> kernel;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& sums) const {
    sums = kernel(particles, at.particle[0]);
  }
};

// Extremes that determine the next step.
template <int Dim>
struct FindExtremes {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = band::StepExtremes;

  band::BandPhysics physics;
  band::HydraulicConductivity hydraulic;
  band::FreeGaps free_gaps;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& found) const {
    found = band::extremes_of_particle<Dim>(physics, hydraulic, free_gaps, particles, at.particle[0]);
  }
};

// Sums for history rows.
template <int Dim>
struct SumOverBody {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = band::BodySums<Dim>;

  band::SumsOfParticle<Dim> of_particle;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& sums) const {
    sums = of_particle(particles, at.particle[0]);
  }
};

}  // namespace thawslide::device
