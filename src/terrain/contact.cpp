#include "terrain/contact.hpp"

#include <cmath>
#include <limits>

#include "base/instances.hpp"
#include "physics/contact.hpp"
#include "terrain/base_pressure.hpp"
#include "terrain/main_axis.hpp"

namespace thawslide::terrain {

namespace {

using mpm::Averages;
using mpm::BaseLayout;
using mpm::Contact;
using mpm::MomentumLayout;
using mpm::MotionLayout;
using mpm::NearGround;

// The smallest contact area, as a share of a cell's face: keeps N = p.n / (A dt) finite where no ground is near.
constexpr double smallest_area = 1e-6;

// One node on its way from trial to final momentum.
template <int Dim, class Real>
struct NodeState {
  Real mass;
  Vector<Real, Dim> old_momentum, momentum;
  Vector<Real, Dim> constraint_impulse;  // of walls and frames [N s]
  bool in_frame;
};

template <int Dim, class Real>
void constrain(const mpm::BlockConstraints<Dim, Real>& constraints, std::size_t k, NodeState<Dim, Real>& state) {
  if (constraints.any()) {
    const Vector<Real, Dim> before = state.momentum;
    state.in_frame = constraints.apply(k, state.mass, state.momentum);
    state.constraint_impulse += state.momentum - before;
  }
}

template <int Dim, class Real>
NodeState<Dim, Real> trial_state(
    const mpm::BlockConstraints<Dim, Real>& constraints, std::size_t k, Real dt, Real damping,
    const typename mpm::NodeRecords<Dim, Real, MomentumLayout<Dim>::size>::Record& record) {
  NodeState<Dim, Real> state;
  state.mass = record[MomentumLayout<Dim>::mass];
  state.old_momentum = mpm::vector_at<Dim, Real>(record, MomentumLayout<Dim>::momentum);
  state.momentum = state.old_momentum + dt * mpm::vector_at<Dim, Real>(record, MomentumLayout<Dim>::force) -
                   damping * dt * state.old_momentum;
  state.constraint_impulse.setZero();
  state.in_frame = false;
  constrain(constraints, k, state);
  return state;
}

// The contact nodes of one block, with what the basal law needs of them.
template <int Dim, class Real>
struct BlockContact {
  template <class T>
  using Column = typename BasalNodes<Real>::template Column<T>;

  BasalNodes<Real> basal;
  Column<std::size_t> node;
  Column<Real> area;
  Column<NodeState<Dim, Real>> state;
};

// Where band columns lie under the slide, the base is as they have it; where none has been laid yet, as the body is.
template <class Record, class Real>
void take_columns_state(const Record& state, bool pore_pressure, std::size_t c, BasalNodes<Real>& basal) {
  using mpm::BaseState;
  const Real area = state[BaseState::area];
  if (!(area > Real(0))) {
    basal.pore_pressure[c] = Real(0);
    return;
  }
  basal.pore_pressure[c] = pore_pressure ? state[BaseState::pressure_ratio] / area * basal.normal_pressure[c] : Real(0);
  basal.saturation[c] = state[BaseState::saturation] / area;
  basal.solid_fraction[c] = state[BaseState::solid_fraction] / area;
  basal.temperature[c] = state[BaseState::temperature] / area;
  basal.slip[c] = state[BaseState::slip] / area;
}

template <int Dim, class Real>
void add_contact_node(const mpm::Nodes<Dim, Real>& nodes, std::size_t b, std::size_t k, Real pressure, Real dt,
                      const ContactModel<Dim, Real>& model, const GroundAtNode<Dim, Real>& ground,
                      const NodeState<Dim, Real>& state, BlockContact<Dim, Real>& contact) {
  using mpm::NodalState;
  const auto& known = nodes.state(b, k);
  const auto& near_ground = nodes.near_ground(b, k);
  const Real volume = nodes.averages(b, k)[Averages::volume];
  // A node may have GIMP mass but no linear weight: then its averages are by mass.
  const auto average = [&](Real by_linear, std::size_t by_mass) {
    return volume > Real(0) ? by_linear : near_ground[by_mass] / state.mass;
  };
  BasalNodes<Real>& basal = contact.basal;
  const std::size_t c = basal.count++;
  const Real load = nodes.base(b, k)[BaseLayout::load];
  const Real area = load / (pressure * dt);  // the base is shared among nodes by the load they carry
  contact.node[c] = k;
  contact.area[c] = area;
  contact.state[c] = state;
  basal.substrate[c] = ground.substrate;
  basal.normal_pressure[c] = pressure;
  basal.pore_pressure[c] =
      model.pore_pressure ? average(known[NodalState::pore_pressure], NearGround::pore_pressure) : Real(0);
  basal.saturation[c] = average(near_ground[NearGround::saturation_by_linear] / volume, NearGround::saturation);
  basal.solid_fraction[c] =
      average(near_ground[NearGround::solid_fraction_by_linear] / volume, NearGround::solid_fraction);
  basal.temperature[c] = average(known[NodalState::temperature], NearGround::temperature);
  basal.slip[c] = near_ground[NearGround::slip] / state.mass;
  if (model.band_columns) {
    take_columns_state(nodes.base_state(b, k), model.pore_pressure, c, basal);
  }
  basal.speed[c] = (state.momentum - state.momentum.dot(ground.normal) * ground.normal).norm() / state.mass;
}

// How much of the space that belongs to a node slide fills, 0 to 1.
template <int Dim, class Real>
Real filled_share(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                  const mpm::Nodes<Dim, Real>& nodes, std::size_t b, std::size_t k) {
  const bool near_ground = ground.any_candidate(b) && ground.block(b)[k].candidate;
  const Real cell = grid.cell();
  const Real space = near_ground ? ground.block(b)[k].space : Dim == 2 ? cell * cell : cell * cell * cell;
  const Real volume = nodes.momentum(b, k)[MomentumLayout<Dim>::volume];
  return volume < space ? volume / space : Real(1);
}

// The share of its ground that a slide over a node covers: as much as it fills of the node's space or of those of the
// two nodes further from the ground, since contact is felt before the gap below the slide is closed.
template <int Dim, class Real>
Real covered_share(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                   const mpm::Nodes<Dim, Real>& nodes, std::size_t b, std::size_t k) {
  using T = mpm::Tile<Dim>;
  const Vector<Real, Dim>& into_ground = ground.block(b)[k].normal;
  const int axis = main_axis<Dim, Real>(into_ground);
  const int outward = into_ground[axis] > Real(0) ? -1 : 1;
  Real share = filled_share(grid, ground, nodes, b, k);
  for (int step = 1; step <= 2 && share < Real(1); ++step) {
    const typename T::Beside further = T::beside(static_cast<int>(k), axis, step * outward);
    const std::int32_t block = grid.blocks_about_block(b)[further.direction];
    if (block != KeyIndex::absent) {
      share = std::max(share, filled_share(grid, ground, nodes, static_cast<std::size_t>(block),
                                           static_cast<std::size_t>(further.local)));
    }
  }
  return share;
}

// Fills nodes.base of the blocks that have candidate nodes: how every candidate node presses on the ground, and the
// area it covers.
template <int Dim, class Real>
void press_on_ground(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                     const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model, Real time,
                     Real dt, mpm::Nodes<Dim, Real>& nodes) {
  nodes.base.hold(grid.blocks().size(), [&](std::size_t b) { return ground.any_candidate(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!ground.any_candidate(b)) {
      return;
    }
    const mpm::BlockConstraints<Dim, Real> on_block(grid, constraints, b, time);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      auto& base = nodes.base.of_block(b)[k];
      base.fill(Real(0));
      if (!ground.block(b)[k].candidate) {
        continue;
      }
      const GroundAtNode<Dim, Real>& known = ground.block(b)[k];
      const auto& record = nodes.momentum(b, k);
      if (record[MomentumLayout<Dim>::mass] > Real(0)) {
        const auto state = trial_state(on_block, k, dt, model.mass_damping, record);
        base[BaseLayout::load] =
            approach_of(nodes, b, k, model.distance_check, dt, state.mass, state.momentum.dot(known.normal));
      }
      // A node that a hovering slide does not reach has its share of the ground below it all the same.
      base[BaseLayout::covered] = known.area * covered_share(grid, ground, nodes, b, k);
    }
  });
}

// What a sliding node takes of the bed, whose record it fills; its momentum along the slip is still that after
// friction.
template <int Dim, class Real>
Bite<Real> bite_of_node(const Bed<Dim, Real>& bed, const physics::ContactImpulse<Real>& impulse,
                        const Vector<Real, Dim>& along, Real tangential_size, Real area, Real strength, Real dt,
                        Real mass, typename decltype(mpm::Nodes<Dim, Real>::bed)::Record& record) {
  using Layout = mpm::BedLayout<Dim>;
  const Real available = record[Layout::available];
  if (!impulse.slides || !(available > Real(0))) {
    return {};
  }
  const Real speed = (tangential_size - impulse.tangential) / mass;
  const Bite<Real> bite = bed.bite(available, mass, speed, strength, impulse.normal / (area * dt), area, dt);
  record[Layout::taken] = bite.taken;
  mpm::set_vector<Dim>(record, Layout::impulse, Vector<Real, Dim>(bite.impulse * along));
  return bite;
}

// Applies the contact impulse of one node and adds its work. state.momentum goes from trial to final. `bed` may be
// null.
template <int Dim, class Real>
void apply_contact(const mpm::BlockConstraints<Dim, Real>& constraints, std::size_t k, const Vector<Real, Dim>& normal,
                   Real load, Real area, Real strength, Real friction, Real heat_fraction, Real dt,
                   const Bed<Dim, Real>* bed, typename decltype(mpm::Nodes<Dim, Real>::bed)::Record* of_bed,
                   NodeState<Dim, Real>& state, ContactWork<Dim, Real>& work,
                   typename mpm::RecordsOf<Contact, Dim, Real>::Record& left) {
  const Vector<Real, Dim> tangential = state.momentum - state.momentum.dot(normal) * normal;
  const Real tangential_size = tangential.norm();
  auto impulse = physics::contact_impulse(load, tangential_size, area, dt, strength);
  Vector<Real, Dim> along = Vector<Real, Dim>::Zero();
  if (tangential_size > Real(0)) {
    along = tangential / tangential_size;
  }
  Bite<Real> bite;
  if (bed != nullptr) {
    bite = bite_of_node(*bed, impulse, along, tangential_size, area, strength, dt, state.mass, *of_bed);
    impulse.tangential -= bite.of_friction;
  }
  const Vector<Real, Dim> total = -impulse.normal * normal - impulse.tangential * along;
  const Vector<Real, Dim> to_bed = bite.impulse * along;
  state.momentum += total - to_bed;
  constrain(constraints, k, state);  // walls and frames outrank the ground
  const Vector<Real, Dim> middle = (state.old_momentum + state.momentum) / (Real(2) * state.mass);
  const Real slip_speed = std::max(Real(0), middle.dot(along));
  const Real friction_work = impulse.slides ? impulse.tangential * slip_speed : Real(0);
  if (bite.taken > Real(0)) {
    (*of_bed)[mpm::BedLayout<Dim>::work] = to_bed.dot(middle);
    work.bed_work += to_bed.dot(middle);
    work.bed_impulse += to_bed;
  }
  work.friction_work += friction_work;
  work.converted += (Real(1) - heat_fraction) * friction_work;
  work.loss += -total.dot(middle) - friction_work;
  work.force -= total / dt;
  work.area += area;
  work.friction_area += friction * area;
  work.shear_force += impulse.tangential / dt;
  left[Contact::touching] = Real(1);
  left[Contact::slip_speed] = impulse.slides ? slip_speed : Real(0);
  left[Contact::friction_heat] = heat_fraction * friction_work / dt;
  left[Contact::normal_force] = impulse.normal / dt;
  left[Contact::area] = area;
}

// Records the motion of a node and the energies that constraints, damping and FLIP take.
template <int Dim, class Real>
void finish_node(const NodeState<Dim, Real>& state, bool constrained, Real damping, Real dt,
                 ContactWork<Dim, Real>& work,
                 typename mpm::NodeRecords<Dim, Real, MotionLayout<Dim>::size>::Record& motion) {
  const Real inverse_mass = Real(1) / state.mass, inverse_dt = Real(1) / dt;
  const Vector<Real, Dim> change = state.momentum - state.old_momentum;
  const Vector<Real, Dim> middle = Real(0.5) * inverse_mass * (state.old_momentum + state.momentum);
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::acceleration, change * (inverse_mass * inverse_dt));
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::middle_velocity, middle);
  work.node_kinetic += Real(0.5) * change.squaredNorm() * inverse_mass;
  if (damping > Real(0)) {
    work.constraint_impulse -= damping * dt * state.old_momentum;
    work.damping += damping * dt * state.old_momentum.dot(middle);
  }
  if (constrained) {
    const Real constraint_work = state.constraint_impulse.dot(middle);
    work.constraint_impulse += state.constraint_impulse;
    work.frame_work += state.in_frame ? constraint_work : Real(0);
    work.loss -= state.in_frame ? Real(0) : constraint_work;
  }
}

// No node of a block is in contact; `known`: its nodes' ground.
template <int Dim, class Real>
void start_block(const typename GroundOnGrid<Dim, Real>::Block& known, std::size_t b, mpm::Nodes<Dim, Real>& nodes) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
    nodes.contact.of_block(b)[k] = {known[k].candidate ? Real(1) : Real(0)};
  }
}

// What the nodes of a block know of the ground; null where none is a candidate.
template <int Dim, class Real>
const typename GroundOnGrid<Dim, Real>::Block* candidates_of(const GroundOnGrid<Dim, Real>* ground, std::size_t b) {
  return ground != nullptr && ground->any_candidate(b) ? &ground->block(b) : nullptr;
}

template <int Dim, class Real>
void hold_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                  mpm::Nodes<Dim, Real>& nodes) {
  nodes.contact.hold(grid.blocks().size(), [&](std::size_t b) { return candidates_of(ground, b) != nullptr; });
}

}  // namespace

template <int Dim, class Real>
void start_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                   mpm::Nodes<Dim, Real>& nodes) {
  hold_contact(grid, ground, nodes);
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (nodes.contact.holds(b)) {
      start_block(ground->block(b), b, nodes);
    }
  });
}

template <int Dim, class Real>
ContactWork<Dim, Real> resolve_contact(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                                       const mpm::Constraints<Dim, Real>& constraints,
                                       const ContactModel<Dim, Real>& model, Real time, Real dt,
                                       mpm::Nodes<Dim, Real>& nodes, const Bed<Dim, Real>* bed) {
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  nodes.motion.resize(grid.blocks().size());
  hold_contact(grid, ground, nodes);
  const Real smallest = static_cast<Real>(smallest_area) * (Dim == 2 ? grid.cell() : grid.cell() * grid.cell());
  if (ground != nullptr) {
    press_on_ground(grid, *ground, constraints, model, time, dt, nodes);
  }
  if (bed != nullptr) {
    bed->share_out(grid, nodes);
  }
  using Work = ContactWork<Dim, Real>;
  return parallel_sum<Work>(grid.blocks().size(), [&](std::size_t b, Work& work) {
    const mpm::BlockConstraints<Dim, Real> on_block(grid, constraints, b, time);
    const auto* known = candidates_of(ground, b);
    std::array<Real, block_nodes> pressure{};
    if (known != nullptr) {
      start_block(*known, b, nodes);
      pressure = base_pressure(grid, *ground, nodes, b, dt, smallest);
    }
    const auto finish = [&](const NodeState<Dim, Real>& state, std::size_t k) {
      finish_node(state, on_block.any(), model.mass_damping, dt, work, nodes.motion(b, k));
    };
    BlockContact<Dim, Real> contact;
    for (std::size_t k = 0; k < block_nodes; ++k) {
      nodes.motion(b, k).fill(Real(0));
      if (!(nodes.momentum(b, k)[MomentumLayout<Dim>::mass] > Real(0))) {
        continue;
      }
      const auto state = trial_state(on_block, k, dt, model.mass_damping, nodes.momentum(b, k));
      if (known != nullptr && nodes.base(b, k)[BaseLayout::load] > Real(0)) {
        add_contact_node(nodes, b, k, pressure[k], dt, model, (*known)[k], state, contact);
      } else {
        finish(state, k);
      }
    }
    evaluate_basal_law(model.law, time, contact.basal);
    for (std::size_t c = 0; c < contact.basal.count; ++c) {
      const std::size_t k = contact.node[c];
      const Real strength = model.base_holds ? std::numeric_limits<Real>::infinity() : contact.basal.strength[c];
      apply_contact(on_block, k, (*known)[k].normal, nodes.base(b, k)[BaseLayout::load], contact.area[c], strength,
                    contact.basal.friction[c], model.law.heat_fraction, dt, bed,
                    bed != nullptr ? &nodes.bed.of_block(b)[k] : nullptr, contact.state[c], work,
                    nodes.contact.of_block(b)[k]);
      finish(contact.state[c], k);
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                     \
  template void start_contact<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>*,  \
                                         mpm::Nodes<Dim, Real>&);                                            \
  template ContactWork<Dim, Real> resolve_contact<Dim, Real>(                                                \
      const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>*, const mpm::Constraints<Dim, Real>&, \
      const ContactModel<Dim, Real>&, Real, Real, mpm::Nodes<Dim, Real>&, const Bed<Dim, Real>*);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
