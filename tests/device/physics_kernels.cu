// Device kernels with one particle per thread for every function of src/physics that devices may call, in double
// precision. They are compiled and never run: the test is that they compile, and their register count.
#include <cstddef>
#include <utility>

#include "physics/band_column_step.hpp"
#include "physics/basal/laws.hpp"
#include "physics/clapeyron.hpp"
#include "physics/contact.hpp"
#include "physics/elasticity.hpp"
#include "physics/entrainment.hpp"
#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"
#include "physics/kinematics.hpp"
#include "physics/mixture.hpp"
#include "physics/mohr_coulomb.hpp"
#include "physics/pore_water.hpp"
#include "physics/pressurization.hpp"
#include "physics/principal.hpp"
#include "physics/rigid_motion.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::physics {

using Tensor = SymmetricTensor<double>;

// Access to consecutive numbers of a thread's particle; values of different particles are adjacent in memory.
class Row {
 public:
  __device__ Row(double* numbers, std::size_t particles)
      : number_(numbers + blockIdx.x * blockDim.x + threadIdx.x), particles_(particles) {}

  __device__ double take() {
    const double number = *number_;
    number_ += particles_;
    return number;
  }
  template <int Count>
  __device__ Vector<double, Count> take_vector() {
    Vector<double, Count> vector;
    unrolled<Count>([&](auto k) { vector[k] = take(); });
    return vector;
  }
  template <int Dim>
  __device__ Matrix<double, Dim> take_matrix() {
    Matrix<double, Dim> matrix;
    unrolled<Dim * Dim>([&](auto k) { matrix(k / Dim, k % Dim) = take(); });
    return matrix;
  }
  __device__ void put(double number) {
    *number_ = number;
    number_ += particles_;
  }
  template <int Count>
  __device__ void put(const Vector<double, Count>& vector) {
    unrolled<Count>([&](auto k) { put(vector[k]); });
  }

 private:
  double* number_;
  std::size_t particles_;
};

template <class Law, int Dim>
__global__ void strain_and_stress(Law law, Elastic elastic, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const StrainIncrement<double, Dim> step = strain_increment<double, Dim>(row.take_matrix<Dim>());
  const Tensor old = rotate<double, Dim>(row.take_vector<6>(), step.rotation);
  const Tensor trial = old + stress_increment(elastic, step.strain);
  const ReturnResult<double> now = law.template update<Dim>(trial, row.take());
  result.put<6>(now.stress);
  result.put(now.equivalent_plastic_strain_increment);
  result.put(now.plastic_work_density);
  result.put(now.opening);
  result.put(step.volume_ratio);
}
template __global__ void strain_and_stress<LinearElastic, 2>(LinearElastic, Elastic, double*, double*, std::size_t);
template __global__ void strain_and_stress<LinearElastic, 3>(LinearElastic, Elastic, double*, double*, std::size_t);
template __global__ void strain_and_stress<MohrCoulomb<>, 2>(MohrCoulomb<>, Elastic, double*, double*, std::size_t);
template __global__ void strain_and_stress<MohrCoulomb<>, 3>(MohrCoulomb<>, Elastic, double*, double*, std::size_t);
using SofteningFriction = MohrCoulomb<true>;
template __global__ void strain_and_stress<SofteningFriction, 2>(SofteningFriction, Elastic, double*, double*,
                                                                 std::size_t);
template __global__ void strain_and_stress<SofteningFriction, 3>(SofteningFriction, Elastic, double*, double*,
                                                                 std::size_t);

// Checks whether a particle yields, and the part of its strain that gaps take.
template <int Dim>
__global__ void yield_and_gap(MohrCoulomb<> law, Elastic elastic, double* numbers, double* results,
                              std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const Tensor strain = row.take_vector<6>();
  const double plastic_strain = row.take();
  const Tensor borne = borne_strain<double>(strain, closing_strain(row.take(), row.take()));
  const Tensor trial = stress_increment(elastic, borne);
  result.put(law.may_yield<Dim>(trial, plastic_strain) ? 1.0 : 0.0);
  result.put(law.cohesion(plastic_strain));
  result.put(density_with_gap_closed(row.take(), row.take()));
  const Principal<double> own = principal<Dim>(trial);
  result.put<6>(from_principal(own));
  result.put(Elastic::from_young_poisson(row.take(), row.take()).p_wave_modulus());
}
template __global__ void yield_and_gap<2>(MohrCoulomb<>, Elastic, double*, double*, std::size_t);
template __global__ void yield_and_gap<3>(MohrCoulomb<>, Elastic, double*, double*, std::size_t);

template <int Dim>
__global__ void rigid_motion(double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const Vector<double, Dim> place = row.take_vector<Dim>();
  result.put<rotations<Dim>>(moment_of<Dim>(place, row.take_vector<Dim>()));
  result.put<Dim>(turned<Dim>(row.take_vector<rotations<Dim>>(), place));
  result.put<squares<Dim>>(squares_of<Dim>(place));
}
template __global__ void rigid_motion<2>(double*, double*, std::size_t);
template __global__ void rigid_motion<3>(double*, double*, std::size_t);

template <int Dim>
__global__ void nearest_motion(double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const MassPoints<Dim> points{row.take(), row.take_vector<Dim>(), row.take_vector<squares<Dim>>(),
                               row.take_vector<Dim>(), row.take_vector<rotations<Dim>>()};
  const RigidMotion<Dim> motion = nearest_rigid_motion(points, row.take());
  result.put<Dim>(motion.at_origin);
  result.put<rotations<Dim>>(motion.rotation);
}
template __global__ void nearest_motion<2>(double*, double*, std::size_t);
template __global__ void nearest_motion<3>(double*, double*, std::size_t);

template <class Curve>
__global__ void heat(HeatContent<Curve> law, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double temperature = row.take(), change = row.take(), porosity = row.take();
  const double content = law.content(temperature, porosity);
  const double warmer = law.temperature(content + row.take(), porosity, temperature);
  result.put(law.apparent_capacity(temperature, porosity));
  result.put(law.is_negligible(change) ? 0.0 : law.secant_capacity(temperature, change, porosity));
  result.put(warmer);
  result.put(law.curve.saturation(warmer));
  result.put(law.curve.temperature(row.take()));
  result.put(law.coefficients(porosity).melting);
}
template __global__ void heat<PowerLawCurve>(HeatContent<PowerLawCurve>, double*, double*, std::size_t);
template __global__ void heat<LinearCurve>(HeatContent<LinearCurve>, double*, double*, std::size_t);

template <class Curve>
__global__ void band_column(ColumnModel<Curve> model, const double* temperatures, const ColumnDrive* drives,
                            BandColumn* columns, ColumnBudget* totals, BandMeans* means, ColumnVolumes* volumes,
                            double* liquid) {
  const std::size_t k = blockIdx.x * blockDim.x + threadIdx.x;
  ColumnDrive drive = drives[k];
  drive.body_heat = body_enthalpy(model, temperatures[k]);
  totals[k] = step_column(model, drive, columns[k]);
  means[k] = band_means(model, drive.normal_pressure, columns[k]);
  volumes[k] = column_volumes(model, drive.normal_pressure, columns[k]);
  liquid[k] = liquid_volume(model, columns[k]);
}
template __global__ void band_column<PowerLawCurve>(ColumnModel<PowerLawCurve>, const double*, const ColumnDrive*,
                                                    BandColumn*, ColumnBudget*, BandMeans*, ColumnVolumes*, double*);
template __global__ void band_column<LinearCurve>(ColumnModel<LinearCurve>, const double*, const ColumnDrive*,
                                                  BandColumn*, ColumnBudget*, BandMeans*, ColumnVolumes*, double*);

template <class Curve>
__global__ void join_columns(ColumnModel<Curve> model, const double* fractions, const BandColumn* others, double load,
                             BandColumn* columns) {
  const std::size_t k = blockIdx.x * blockDim.x + threadIdx.x;
  BandColumn other = others[k];
  apply_cell_growth(model, columns[k].cell_growth, body_enthalpy(model, 0.0), water_of_full_pores(model, 0.0), other);
  columns[k] = joined_columns(model, fractions[k], columns[k], other, load);
}
template __global__ void join_columns<PowerLawCurve>(ColumnModel<PowerLawCurve>, const double*, const BandColumn*,
                                                     double, BandColumn*);
template __global__ void join_columns<LinearCurve>(ColumnModel<LinearCurve>, const double*, const BandColumn*, double,
                                                   BandColumn*);

template <class Curve>
__global__ void start_columns(ColumnModel<Curve> model, double thickness, const double* temperatures, double load,
                              BandColumn* columns, double* sums) {
  const std::size_t k = blockIdx.x * blockDim.x + threadIdx.x;
  const double cell_growth = cell_growth_below(sums[k], thickness, model.growth);
  columns[k] = start_column(model, thickness, cell_growth, temperatures[k], temperatures[k], load);
  sums[k] = heat_of(columns[k]) + water_of(columns[k]);
}
template __global__ void start_columns<PowerLawCurve>(ColumnModel<PowerLawCurve>, double, const double*, double,
                                                      BandColumn*, double*);

__global__ void mixture(Phases phases, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double porosity = row.take(), saturation = row.take();
  result.put(effective_solid_fraction(phases, porosity, saturation));
  result.put(mixture_density(phases, porosity, saturation));
  result.put(heat_capacity(phases, porosity, saturation));
  result.put(conductivity(phases, porosity, saturation));
  result.put(expansion(phases, porosity, saturation));
  result.put(updated_porosity(phases, porosity, row.take(), row.take()));
  result.put(mixed(porosity, row.take(), row.take()));
}

__global__ void pore_water(Phases phases, double gravity, double dt, double sign, bool as_published, double* numbers,
                           double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double porosity = row.take(), saturation = row.take(), temperature = row.take();
  const double ice = ice_pressure(phases, gravity, row.take());
  const double liquid = liquid_pressure_clapeyron(phases, ice, temperature, row.take(), sign);
  result.put(pore_pressure(saturation, liquid, ice));
  result.put(undrained_pressure_coefficient(phases, porosity, saturation));
  result.put(pore_stiffness(phases, porosity, saturation));
  const double scaling = pore_space_scaling(row.take(), as_published);
  const double diffusivity = hydraulic_diffusivity(phases, porosity, saturation, scaling * row.take());
  result.put(subgrid_diffusion_fraction(diffusivity, row.take(), 3, dt));
}

__global__ void water_balance(Phases phases, WaterExpansion water, double skeleton_compressibility, double* numbers,
                              double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double porosity = row.take(), from = row.take(), to = row.take(), load = row.take();
  const double storage = pore_storage(phases, porosity, skeleton_compressibility);
  const double gas_void = melting_void(phases, porosity, row.take());
  result.put(expansion(phases, porosity, row.take(), water.at(to)));
  const double surplus =
      thawing_surplus(storage, load, row.take(), gas_void) + melted_swelling(phases, water, porosity, from, to);
  const PoreFilling<double> filling = pore_filling(surplus, storage, load);
  result.put(filling.pressure);
  result.put(pore_surplus(filling, storage));
  result.put(pore_filling(surplus, storage).gas_void);
  result.put(storing_porosity(phases, porosity, skeleton_compressibility));
}

__device__ basal::ContactNode take_node(Row& row) {
  return {row.take(), row.take(), row.take(), row.take(), row.take(), row.take(), row.take(), row.take(), row.take()};
}

template <class Law>
__global__ void friction_law(Law law, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const basal::ContactNode node = take_node(row);
  result.put(law.coefficient(node));
  result.put(basal::drag_of(law, node));
}
template <class Law>
__global__ void cohesion_law(Law law, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  result.put(law.cohesion(take_node(row)));
}

// One kernel for each law of the lists.
void use_every_law(void (*use)(const void* kernel)) {
  basal::for_each_law<basal::FrictionLaw>(
      [&]<class Law>(basal::OfType<Law>) { use(reinterpret_cast<const void*>(friction_law<Law>)); });
  basal::for_each_law<basal::CohesionLaw>(
      [&]<class Law>(basal::OfType<Law>) { use(reinterpret_cast<const void*>(cohesion_law<Law>)); });
}

__global__ void basal_contact(FrictionClamp clamp, bool cap_pressure, double dt, double* numbers, double* results,
                              std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double strength = sliding_strength(row.take(), row.take(), row.take(), row.take(), clamp, cap_pressure);
  const ContactImpulse impulse = contact_impulse(row.take(), row.take(), row.take(), dt, strength);
  result.put(impulse.normal);
  result.put(impulse.tangential);
  result.put(impulse.slides ? 1.0 : 0.0);
}

__global__ void body_contact(double dt, double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const BodyImpulse impulse = body_impulse(row.take(), row.take(), row.take(), row.take(), row.take(), dt, row.take());
  result.put(impulse.normal);
  result.put(impulse.tangential);
}

__global__ void entrainment(double* numbers, double* results, std::size_t particles) {
  Row row(numbers, particles), result(results, particles);
  const double strength = bed_strength(row.take(), row.take(), row.take()), speed = row.take();
  result.put(erosion_by_strength(row.take(), strength, speed, row.take()));
  result.put(erosion_by_momentum(row.take(), strength, row.take(), speed, row.take()));
  result.put(speed_after_entrainment(row.take(), speed, row.take()));
}

}  // namespace thawslide::physics
