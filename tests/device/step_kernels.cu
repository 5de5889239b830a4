// Kernels of the step (mpm/kernel.hpp) in device code, with one particle per thread as in device/particle_pass.hpp, in
// double precision. They are compiled and never run: the test is that they compile, and their register count.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "band/averages_kernel.hpp"
#include "band/columns_of_tile.hpp"
#include "band/heat_kernels.hpp"
#include "band/pressure_kernels.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/one_particle.hpp"
#include "mpm/particle_view.hpp"
#include "mpm/position_kernel.hpp"
#include "mpm/stress_kernel.hpp"
#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"
#include "terrain/band_marks_kernel.hpp"
#include "terrain/near_ground_kernel.hpp"

namespace thawslide {

// Particles of a tile, and the records of its nodes.
template <int Dim>
struct TileOnDevice {
  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;
  const std::uint32_t* particle;
  const std::int32_t* nearest[Dim];
  const std::uint32_t* first_node;
  const double* records;
  double* totals;
  std::size_t count;
  double cell, inverse_cell;
  int sides[2][Dim];
};

template <class Name, int Dim>
struct PatchOnDevice {
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);
  static constexpr std::size_t total = static_cast<std::size_t>(mpm::power(mpm::Tile<Dim>::patch_edge, Dim)) * size;
  const double* numbers;
};

// Copies a tile's patch, if any, to shared memory, one number per thread.
template <int Dim, class... Names>
__device__ auto fetch(mpm::RecordList<Names...> /*names*/, const double* records, double* shared) {
  static_assert(sizeof...(Names) <= 1, "no kernel reads more");
  const auto copy = [&](std::size_t numbers) {
    for (std::size_t k = threadIdx.x; k < numbers; k += blockDim.x) {
      shared[k] = records[k];
    }
    __syncthreads();
    return shared;
  };
  return mpm::ByName<mpm::Named<Names, PatchOnDevice<Names, Dim>>...>{
      {PatchOnDevice<Names, Dim>{copy(PatchOnDevice<Names, Dim>::total)}}...};
}

template <class Name, int Dim>
using CarriedTo = mpm::CarriedByOne<Name, Dim>;
template <int Dim, class List>
struct CarriedOf;
template <int Dim, class... Names>
struct CarriedOf<Dim, mpm::RecordList<Names...>> {
  using Type = mpm::ByName<mpm::Named<Names, CarriedTo<Names, Dim>>...>;
};

// Runs a kernel for the thread's particle. Shape: of momentum.
template <class Shape, int Dim, class Kernel>
__device__ void visit(const TileOnDevice<Dim>& tile, typename CarriedOf<Dim, typename Kernel::Adds>::Type* carried,
                      typename Kernel::Totals* totals, const Kernel& kernel) {
  extern __shared__ double shared[];
  const auto patches = fetch<Dim>(typename Kernel::Reads{}, tile.records, shared);
  const std::size_t k = threadIdx.x;
  if (k >= tile.count) {
    return;
  }
  mpm::ParticleView<Dim> particles = tile.particles;
  const mpm::ScalarIndex at{{tile.particle[k]}};
  mpm::OneGridPosition<Dim> position{{}, tile.first_node[k], {}};
  for (std::size_t a = 0; a < Dim; ++a) {
    const std::int32_t nearest = tile.nearest[a][k];
    position.offset[static_cast<int>(a)] =
        particles.position(at.particle[0], static_cast<int>(a)) * tile.inverse_cell - static_cast<double>(nearest);
    position.at_side[a] = nearest == tile.sides[0][a] || nearest == tile.sides[1][a];
  }
  mpm::OneWeights<Dim> weights(mpm::Mapping{}, particles, at);
  weights.set_linear(position, tile.inverse_cell);
  weights.template set_momentum<Shape>(position, tile.sizes.of(particles, at), tile.inverse_cell);
  weights.template set_affine<Shape>(position, tile.cell, tile.inverse_cell);
  const mpm::ScalarGather<mpm::OneWeights<Dim>, decltype(patches)> seen{weights, patches};
  typename CarriedOf<Dim, typename Kernel::Adds>::Type added{};
  typename Kernel::Totals own{};
  kernel(particles, at, seen, added, own);
  carried[k] = added;
  totals[k] = own;
}

template <int Dim, class Kernel>
struct Results {
  typename CarriedOf<Dim, typename Kernel::Adds>::Type* carried;
  typename Kernel::Totals* totals;
};

template <int Dim>
using Shape = mpm::Ugimp;

// Kernels whose only template parameter is the dimension.
template <int Dim, template <int> class Kernel>
__global__ void pass(TileOnDevice<Dim> tile, Results<Dim, Kernel<Dim>> to, Kernel<Dim> kernel) {
  visit<Shape<Dim>>(tile, to.carried, to.totals, kernel);
}

template <int Dim, class Law>
__global__ void deform(TileOnDevice<Dim> tile, Results<Dim, mpm::Deform<Dim, Law>> to, Law law,
                       mpm::MaterialParameters material, physics::Phases phases, bool effective_stress, double dt) {
  const mpm::Deform<Dim, Law> kernel{law, material, phases, effective_stress, dt};
  visit<Shape<Dim>>(tile, to.carried, to.totals, kernel);
}

template <class Curve>
using Content = physics::HeatContent<Curve>;
template <class Curve>
using Law = band::ParticleHeat<Content<Curve>, band::InitialMasses>;

template <int Dim, class Curve>
__global__ void heat_flows(TileOnDevice<Dim> tile, Results<Dim, band::HeatFlows<Dim, Law<Curve>>> to,
                           Content<Curve> content, band::BandPhysics model, band::HydraulicConductivity hydraulic,
                           double dt, bool subgrid) {
  const Law<Curve> law{content};
  const band::HeatFlows<Dim, Law<Curve>> kernel{model, hydraulic, law, dt, tile.inverse_cell, subgrid};
  visit<Shape<Dim>>(tile, to.carried, to.totals, kernel);
}

template <int Dim, class Curve>
__global__ void secant_capacity(TileOnDevice<Dim> tile, Results<Dim, band::SecantCapacity<Dim, Law<Curve>>> to,
                                Content<Curve> content, double dt) {
  const Law<Curve> law{content};
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::SecantCapacity<Dim, Law<Curve>>{law, dt});
}

template <int Dim, class Curve>
__global__ void take_heat(TileOnDevice<Dim> tile, Results<Dim, band::UpdateHeat<Dim, Law<Curve>>> to,
                          Content<Curve> content, band::BandPhysics model, double dt) {
  const Law<Curve> law{content};
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::UpdateHeat<Dim, Law<Curve>>{model, law, dt});
}

template <int Dim, class Curve>
__global__ void update_heat_as_published(TileOnDevice<Dim> tile,
                                         Results<Dim, band::UpdateHeatApparentCapacity<Dim, Law<Curve>>> to,
                                         Content<Curve> content, band::BandPhysics model, double dt) {
  const Law<Curve> law{content};
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::UpdateHeatApparentCapacity<Dim, Law<Curve>>{model, law, dt});
}

template <int Dim, class Curve>
__global__ void new_heat_masses(TileOnDevice<Dim> tile, Results<Dim, band::UpdateHeatMass<Dim, Law<Curve>>> to,
                                Content<Curve> content) {
  const Law<Curve> law{content};
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::UpdateHeatMass<Dim, Law<Curve>>{law});
}

template <int Dim>
__global__ void seepage(TileOnDevice<Dim> tile, Results<Dim, band::SeepageFlows<Dim>> to, band::BandPhysics model,
                        band::HydraulicConductivity hydraulic, double dt) {
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::SeepageFlows<Dim>{model, hydraulic, dt, tile.inverse_cell});
}

template <int Dim>
__global__ void seeping_water(TileOnDevice<Dim> tile, Results<Dim, band::AddSeepingWater<Dim>> to,
                              band::BandPhysics model, band::HydraulicConductivity hydraulic) {
  visit<Shape<Dim>>(tile, to.carried, to.totals, band::AddSeepingWater<Dim>{model, hydraulic});
}

template <int Dim, bool Balances>
using Pressure = band::PorePressure<const band::ColumnsOfTile<Dim>&, true, Balances>;

template <int Dim, bool Balances>
__global__ void pore_pressure(TileOnDevice<Dim> tile, Results<Dim, Pressure<Dim, Balances>> to, band::BandPhysics model,
                              band::HydraulicConductivity hydraulic, const band::ColumnsOfTile<Dim>* columns) {
  visit<Shape<Dim>>(tile, to.carried, to.totals, Pressure<Dim, Balances>{model, hydraulic, 0.5 * tile.cell, *columns});
}

// Columns of the slide: overlap of a box, a column at the body's edge, and the load of a particle below one.
template <int Dim>
__global__ void box_in_columns(std::uint64_t tile_key, TileOnDevice<Dim> tile, band::Overlaps<Dim, double>* overlaps) {
  const mpm::ScalarIndex at{{tile.particle[threadIdx.x]}};
  overlaps[threadIdx.x] = band::overlaps<Dim>(band::first_cell_of<Dim>(tile_key), tile.cell, tile.inverse_cell,
                                              tile.sizes, tile.particles, at);
}
template <int Dim>
__global__ void column(std::uint64_t tile_key, double cell, const bool* filled, const band::ColumnMass* piles,
                       const band::Extent<Dim>* extents, std::uint64_t* keys, double* thickness, double* load) {
  const std::size_t k = threadIdx.x;
  const auto is_filled = [&](std::size_t side) { return filled[k * band::column_sides<Dim> + side]; };
  const bool at_edge = band::lacks_neighbour<Dim>(is_filled);
  keys[k] = band::neighbour_column(band::column_key<Dim>(tile_key, k), k % 2);
  thickness[k] = band::thickness_of(piles[k], band::footprint_of<Dim>(cell, at_edge, extents[k], is_filled));
  load[k] = band::load_per_depth(piles[k], load[k], 10.0);
}
template <int Dim>
__global__ void load(TileOnDevice<Dim> tile, band::ColumnsOfTile<Dim, band::NumbersOfColumns> columns) {
  const mpm::ScalarIndex at{{tile.particle[threadIdx.x]}};
  band::update_load(tile.particles, at.particle[0], columns.flow_depth(tile.particles, at));
}

// Second phase of a pass: reduces the contributions of particles first .. last-1 of a cell to a number of one of its
// nodes, by sum or minimum.
template <class Name, int Dim>
__global__ void sum_in_cell(const mpm::OneWeights<Dim>* weights, const CarriedTo<Name, Dim>* carried, std::size_t first,
                            std::size_t last, double* sums) {
  const std::size_t node = threadIdx.x, component = threadIdx.y;
  double sum = sums[node * blockDim.y + component];
  for (std::size_t k = first; k < last; ++k) {
    const std::array<std::size_t, 3> along{node % 3, node / 3 % 3, node / 9};
    const auto at = mpm::at_node<Dim>(weights[k].template of<typename Name::Functions>(), along);
    sum = at.is_seen ? mpm::add_particle(at, carried[k], component, sum) : sum;
  }
  sums[node * blockDim.y + component] = sum;
}

template <int Dim>
void instantiate() {
  using Elastic = physics::LinearElastic;
  using Coulomb = physics::MohrCoulomb<>;
  using PowerLaw = physics::PowerLawCurve;
  using Line = physics::LinearCurve;
  TileOnDevice<Dim> tile{};
  pass<Dim, band::AddAverages><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::AddMomentum><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::AddAffineMomentum><<<1, 128>>>(tile, {}, {});
  pass<Dim, terrain::AddNearGround><<<1, 128>>>(tile, {}, {});
  pass<Dim, terrain::LowerClearance><<<1, 128>>>(tile, {}, {});
  pass<Dim, terrain::MarkBand><<<1, 128>>>(tile, {}, {});
  pass<Dim, terrain::LeaveBand><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::UpdatePosition><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::Move><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::MoveAffine><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::AddFilterMoments><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::AddFilterMomentum><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::SweepFilter><<<1, 128>>>(tile, {}, {});
  pass<Dim, mpm::ApplyFiltered><<<1, 128>>>(tile, {}, {});
  deform<Dim, Elastic><<<1, 128>>>(tile, {}, {}, {}, {}, false, 0);
  deform<Dim, Coulomb><<<1, 128>>>(tile, {}, {}, {}, {}, false, 0);
  deform<Dim, physics::MohrCoulomb<true>><<<1, 128>>>(tile, {}, {}, {}, {}, false, 0);
  heat_flows<Dim, PowerLaw><<<1, 128>>>(tile, {}, {}, {}, {}, 0, true);
  heat_flows<Dim, Line><<<1, 128>>>(tile, {}, {}, {}, {}, 0, true);
  secant_capacity<Dim, PowerLaw><<<1, 128>>>(tile, {}, {}, 0);
  secant_capacity<Dim, Line><<<1, 128>>>(tile, {}, {}, 0);
  take_heat<Dim, PowerLaw><<<1, 128>>>(tile, {}, {}, {}, 0);
  take_heat<Dim, Line><<<1, 128>>>(tile, {}, {}, {}, 0);
  update_heat_as_published<Dim, PowerLaw><<<1, 128>>>(tile, {}, {}, {}, 0);
  new_heat_masses<Dim, PowerLaw><<<1, 128>>>(tile, {}, {});
  pass<Dim, band::RedistributeUnreachedHeat><<<1, 128>>>(tile, {}, {});
  seepage<Dim><<<1, 128>>>(tile, {}, {}, {}, 0);
  seeping_water<Dim><<<1, 128>>>(tile, {}, {}, {});
  box_in_columns<Dim><<<1, 128>>>(0, tile, nullptr);
  column<Dim><<<1, 128>>>(0, 0, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr);
  load<Dim><<<1, 128>>>(tile, {});
  pore_pressure<Dim, false><<<1, 128>>>(tile, {}, {}, {}, nullptr);
  pore_pressure<Dim, true><<<1, 128>>>(tile, {}, {}, {}, nullptr);
  sum_in_cell<mpm::Momentum, Dim><<<1, 128>>>(nullptr, nullptr, 0, 0, nullptr);
  sum_in_cell<mpm::HeatRates, Dim><<<1, 128>>>(nullptr, nullptr, 0, 0, nullptr);
  sum_in_cell<mpm::Clearance, Dim><<<1, 128>>>(nullptr, nullptr, 0, 0, nullptr);
}
template void instantiate<2>();
template void instantiate<3>();

}  // namespace thawslide
