// Contact with the ground on an executor (Eqs. 15-17, 20, 25; Nairn 2013; Nairn et al. 2018), written once for the CPU
// and devices as a sequence of passes. Passes of the CPU (terrain/contact.cpp) and of devices
// (device/contact_passes.hpp) provide, in a step:
//   has_ground(), candidate_count(), time(), dt()
//   near_ground_to_grid(with_state)  clearance of candidate nodes, and, if required, the state of the mass above them
//   for_candidates(kernel)           calls kernel(step, node, candidate) for the candidate nodes
//   add_nodes(kernel, to)            calls kernel(step, node, candidate, contact, motion) for all nodes, and stores the
//                                    total of the last two. Sums of nodes that the kernel touches() are added after
//                                    those of the others in a block, `contact` before `motion`.
//   visit_particles(kernel)          calls a kernel that neither reads nor adds to nodes for all particles
//   linear_near_ground(kernel)       calls a kernel for the particles near the ground
#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include "terrain/bed_stage.hpp"
#include "terrain/contact_kernels.hpp"
#include "terrain/near_ground_kernels.hpp"

namespace thawslide::terrain {

struct ContactModel : ContactOptions {
  BasalLaw law;
  bool reads_mass = true;     // the laws depend on P, T, S, n_e or the slip of the mass at nodes
  bool band_columns = false;  // the basal state is that of band columns
};

// The force of the walls of a section along x [N], from that on the ground, of which they are a part.
template <int Dim>
struct SubtractForce {
  const double* of_walls;
  ContactWork<Dim>* contact;

  THAWSLIDE_HD void operator()(std::size_t /*k*/) const { contact->force[0] -= *of_walls; }
};

// Marks the particles in a cell with a candidate corner as band particles, and adds the slip of contact nodes.
template <int Dim, class Passes>
void mark_band_and_slip(Passes& passes, double dt) {
  passes.visit_particles(LeaveBand<Dim>{});
  passes.linear_near_ground(MarkBand<Dim>{dt});
}

template <class Executor, int Dim>
class ContactStage {
 public:
  explicit ContactStage(Executor& executor) : executor_(executor) {}

  // From nodal momentum and force to nodal motion: trial momentum, constraints, contact. columns: basal state of band
  // columns. average_band(): computes the averages of the band, if nodes out of reach of band columns need them.
  // Otherwise, these have been computed if the laws depend on the mass. bed: the same in all steps, or null. strength:
  // replaces the strengths of the case's laws unless it is null or the base is fixed. of_walls: force of the walls of a
  // section along x [N]; null if there are none. work: in memory of the executor.
  template <class Passes, class AverageBand>
  void resolve(Passes& passes, const ContactModel& model, const mpm::BaseStates<Dim>& columns,
               const AverageBand& average_band, Bed<Dim>* bed, const StrengthLaw* strength, const double* of_walls,
               ContactWork<Dim>* work) {
    const double* strengths = nullptr;
    if (passes.has_ground()) {
      evaluate_base(passes, model, columns, model.reads_mass || strength != nullptr, average_band);
      if (strength != nullptr && !model.base_is_fixed) {
        strengths = strengths_by(*strength, passes, model.law);
      }
    }
    if (bed != nullptr) {
      if (!bed_) {
        bed_.emplace(executor_, *bed);
      }
      bed_->distribute(passes);
    }
    passes.add_nodes(
        ResolveContact<Dim>{bases_.data(), strengths, model.law.clamp, model.law.cap_pressure, model.law.heat_fraction,
                            bed != nullptr ? bed_->below_nodes() : BedBelowNodes<Dim>{}},
        work);
    if (of_walls != nullptr) {
      executor_.for_each(1, SubtractForce<Dim>{of_walls, work});
    }
    if (bed != nullptr) {
      bed_->collect(passes.dt());
    }
    if (passes.has_ground()) {
      mark_band_and_slip<Dim>(passes, passes.dt());
    }
  }

 private:
  // Only nodes out of reach of band columns need the state of particles, and only if a law reads it. A device does not
  // wait to find out whether there are any.
  template <class Passes, class AverageBand>
  void evaluate_base(Passes& passes, const ContactModel& model, const mpm::BaseStates<Dim>& columns, bool reads_mass,
                     const AverageBand& average_band) {
    const bool has_columns = columns.records != nullptr;
    passes.near_ground_to_grid(reads_mass && !has_columns);
    passes.for_candidates(PressOnGround{});
    if constexpr (!Passes::is_queued) {
      if (has_columns && reads_mass && passes.any_candidate(LoadsBareGround<Dim>{columns})) {
        average_band();
        passes.near_ground_to_grid(true);
      }
    }
    const double face = Dim == 2 ? passes.cell() : passes.cell() * passes.cell();
    bases_.resize(passes.candidate_count());
    passes.for_candidates(GatherBasalNode<Dim>{static_cast<double>(smallest_area) * face, model.law.gravity,
                                               reads_mass || Passes::is_queued, columns, bases_.data()});
    evaluate_basal_law(executor_, model.law, bases_.data(), bases_.size());
  }

  // Strengths by candidate node [Pa], by a law of the caller.
  template <class Passes>
  [[nodiscard]] const double* strengths_by(const StrengthLaw& law, Passes& passes, const BasalLaw& of_case) {
    positions_.resize(bases_.size() * Dim);
    passes.for_candidates(LocateOnGround<Dim>{positions_.data()});
    const std::vector<double> positions = positions_.get();
    const std::vector<BasalNode> bases = bases_.get();
    LoadedNodes nodes;
    nodes.time = passes.time();
    nodes.dt = passes.dt();
    for (std::size_t k = 0; k < bases.size(); ++k) {
      const physics::basal::ContactNode& state = bases[k].state;
      if (!(bases[k].area > 0.0)) {
        continue;
      }
      nodes.position.insert(nodes.position.end(), &positions[k * Dim], &positions[k * Dim] + Dim);
      nodes.area.push_back(bases[k].area);
      nodes.substrate.push_back(bases[k].substrate);
      nodes.normal_pressure.push_back(state.normal_pressure);
      nodes.pore_pressure.push_back(state.pore_pressure);
      nodes.temperature.push_back(state.temperature);
      nodes.saturation.push_back(state.saturation);
      nodes.solid_fraction.push_back(state.solid_fraction);
      nodes.slip.push_back(state.slip);
      nodes.speed.push_back(state.speed);
      nodes.unit_weight.push_back(state.unit_weight);
      nodes.strength.push_back(bases[k].strength(of_case.clamp, of_case.cap_pressure));
    }
    const std::size_t count = nodes.strength.size();
    law(nodes);
    if (nodes.strength.size() != count) {
      throw std::logic_error("a basal law returned another number of strengths");
    }
    std::vector<double> strengths(bases.size(), 0.0);
    for (std::size_t k = 0, loaded = 0; k < bases.size(); ++k) {
      if (bases[k].area > 0.0) {
        strengths[k] = nodes.strength[loaded++];
      }
    }
    strengths_.set(strengths);
    return strengths_.data();
  }

  Executor& executor_;
  exec::Array<BasalNode, Executor> bases_{executor_};  // by candidate
  exec::Array<double, Executor> positions_{executor_}, strengths_{executor_};
  std::optional<BedStage<Executor, Dim>> bed_;  // none before the bed is in reach
};

}  // namespace thawslide::terrain
