// Replaces particle velocities by those of the rigid motions of their nodes (mpm/velocity_filter.hpp).
#pragma once

#include "device/step_passes.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/filter_node.hpp"

namespace thawslide::device {

// One thread per node.
template <int Dim>
struct MakeIncrement {
  bool first;
  double least_square;
  const double *masses, *moments, *brought;
  double *increments, *totals;

  THAWSLIDE_HD void operator()(std::size_t node) const {
    double* increment = at<mpm::FilterIncrement>(increments, node);
    double* total = at<mpm::FilterTotal>(totals, node);
    mpm::make_increment<Dim>(first, least_square, at<mpm::Momentum>(masses, node),
                             at<mpm::FilterMoments>(moments, node), at<mpm::FilterMomentum>(brought, node), increment,
                             total);
  }

 private:
  template <class Name, class Number>
  THAWSLIDE_HD static Number* at(Number* numbers, std::size_t node) {
    return numbers + node * mpm::record_size(mpm::components_of<Name, Dim>);
  }
};

// Recomputes the momentum in the patches of Velocity. gained: kinetic energy [J], in device memory.
template <class Backend, class Shape, int Dim>
void filter_velocities(StepPasses<Backend, Shape, Dim>& passes, double* gained) {
  using Passes = StepPasses<Backend, Shape, Dim>;
  using Taking = mpm::ApplyFiltered<Dim>;
  const std::size_t nodes = passes.cells.tables().blocks * Passes::block_nodes;
  passes.nodes.template resize_for<mpm::FilterMoments, mpm::FilterMomentum, mpm::FilterIncrement, mpm::FilterTotal>(
      nodes);
  const auto make_increments = [&](bool first) {
    passes.template sum<mpm::FilterMomentum, void>(AllTiles{});
    passes.backend.for_each(
        nodes, MakeIncrement<Dim>{
                   first, mpm::least_square_of(passes.model.cell), passes.template of<mpm::Momentum>().data(),
                   passes.template of<mpm::FilterMoments>().data(), passes.template of<mpm::FilterMomentum>().data(),
                   passes.template of<mpm::FilterIncrement>().data(), passes.template of<mpm::FilterTotal>().data()});
  };
  passes.run(passes.momentum(), mpm::AddFilterMoments<Dim>{});
  passes.template sum<mpm::FilterMoments, void>(AllTiles{});
  passes.run(passes.momentum(), mpm::AddFilterMomentum<Dim>{});
  make_increments(true);
  for (int order = 2; order <= passes.model.motion.filter_order; ++order) {
    passes.run(passes.momentum(), mpm::SweepFilter<Dim>{});
    make_increments(false);
  }
  passes.keep(&passes.run(passes.momentum(), Taking{})->template of<Taking>(), gained);
}

}  // namespace thawslide::device
