// Cells that follow the ground: fields that the mapping must reproduce exactly (mpm/mapping.hpp).
#include <random>

#include "../support/small_terrain.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/following_ground.hpp"
#include "terrain/height_field.hpp"
#include "terrain/polyline.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double cell = 5.0, extent = 100.0;  // [m]

// Random heights half a cell apart, with slopes up to 6.
template <int Dim>
std::shared_ptr<const terrain::Surface<Dim>> random_ground() {
  constexpr double spacing = 0.5 * cell;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(0.0, 6.0 * spacing);
  if constexpr (Dim == 2) {
    std::vector<double> x, z;
    for (double at = -extent; at < 2.0 * extent; at += spacing) {
      x.push_back(at);
      z.push_back(height(random));
    }
    return std::make_shared<terrain::ProfileSurface<2>>(terrain::Polyline(x, z));
  } else {
    const int points = static_cast<int>(2.0 * extent / spacing);
    return std::make_shared<terrain::HeightField>(
        raster(-0.5 * extent, -0.5 * extent, spacing, points, points, [&](double, double) { return height(random); }));
  }
}

template <class ReadRecords, class AddedRecords>
struct Kernel {
  using Reads = ReadRecords;
  using Adds = AddedRecords;
  using Totals = mpm::NoTotals;
};

// Stores velocity and its gradient in the velocity and the affine velocity, and the temperature gradient in the
// displacement.
template <int Dim>
struct ReadVelocity : Kernel<mpm::RecordList<mpm::Velocity>, mpm::RecordList<>> {
  template <class Particles, class At, class Seen, class Scatter>
  void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& /*added*/,
                  mpm::NoTotals& /*totals*/) const {
    const auto read = seen.template read<mpm::Velocity, Dim>();
    const auto gradient = mpm::gradient_of(read);
    particles.affine_velocity.store_vector(at, gradient.reshaped());
    for (int a = 0; a < Dim; ++a) {
      particles.velocity.store(at, read.value[static_cast<std::size_t>(a)], a);
    }
  }
};
template <int Dim>
struct ReadTemperature : Kernel<mpm::RecordList<mpm::NodalState>, mpm::RecordList<>> {
  template <class Particles, class At, class Seen, class Scatter>
  void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& /*added*/,
                  mpm::NoTotals& /*totals*/) const {
    const auto read = seen.template read<mpm::NodalState, 1>(mpm::NodalState::temperature);
    particles.displacement.store_vector(at, mpm::gradient_of(read, 0));
  }
};
// Heat flow equal to the particles' displacement.
template <int Dim>
struct AddHeatFlow : Kernel<mpm::RecordList<>, mpm::RecordList<mpm::HeatRates>> {
  template <class Particles, class At, class Seen, class Scatter>
  void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& added,
                  mpm::NoTotals& /*totals*/) const {
    auto& rates = added.template of<mpm::HeatRates>();
    for (int a = 0; a < Dim; ++a) {
      rates.flux[a][mpm::HeatRates::conduction] = particles.displacement.load(at, a);
    }
  }
};

// Particles at random places from a cell below the ground to four cells above it.
template <int Dim>
class RandomParticles {
 public:
  using Point = Vector<double, Dim>;

  RandomParticles() : terrain_(random_ground<Dim>()) {
    model_.sizes.add(0.25);
    model_.gravity.setZero();
    mpm::MaterialModel material;
    material.law = physics::LinearElastic{};
    model_.materials.push_back(material);
    ground_ = std::make_unique<terrain::FollowingGround<Dim>>(terrain_, cell, Vector<double, Dim - 1>::Constant(extent),
                                                              model_.sizes, mpm::SectionWidth(), HUGE_VAL);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> along(4.0 * cell, extent - 4.0 * cell), above(-cell, 4.0 * cell),
        number(-1.0, 1.0);
    particles.resize(400);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.id(p) = static_cast<std::int64_t>(p);
      particles.volume(p) = 1.5 + number(random);
      particles.mass(p) = 1.0;
      Vector<double, Dim - 1> point;
      for (int a = 0; a + 1 < Dim; ++a) {
        point[a] = particles.position(p, a) = along(random);
      }
      particles.position(p, Dim - 1) = ground_->height(point) + above(random);
      for (int a = 0; a < Dim; ++a) {
        particles.displacement(p, a) = number(random);
      }
      for (int c = 0; c < mpm::tensor_components<Dim>; ++c) {
        particles.stress(p, c) = number(random);
      }
    }
    ground_->locate(particles);
    grid.update(particles, 0);
    nodes.motion.resize(grid.blocks().size());
    nodes.velocity.resize(grid.blocks().size());
    nodes.state.resize(grid.blocks().size());
  }

  // Calls visit(node, position in space).
  template <class Visit>
  void for_nodes(const Visit& visit) {
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
        Point position = mpm::node_position(grid, b, k);
        position[Dim - 1] += terrain_->column_means(position.template head<Dim - 1>(), cell).height;
        visit(mpm::NodeAt{b, k}, position);
      }
    }
  }
  [[nodiscard]] const mpm::MotionModel<Dim>& model() const { return model_; }

  mpm::Particles<Dim> particles;
  mpm::SparseGrid<Dim> grid{cell, {}, {true}};
  mpm::Nodes<Dim> nodes;

 private:
  std::shared_ptr<const terrain::Surface<Dim>> terrain_;
  mpm::MotionModel<Dim> model_;
  std::unique_ptr<terrain::FollowingGround<Dim>> ground_;
};

// Largest errors relative to the largest value and gradient.
struct LinearErrors {
  double value = 0, gradient = 0, displacement = 0, heat_gradient = 0, work = 0, heat = 0;
};

// Velocity A x + c, and temperature g.x, at nodes.
template <int Dim>
LinearErrors errors_of_linear_field(const Matrix<double, Dim>& gradient) {
  using Point = Vector<double, Dim>;
  RandomParticles<Dim> in;
  const Point constant = Point::LinSpaced(1.0, 2.0), heat_gradient = Point::LinSpaced(0.3, -0.2);
  const auto velocity_at = [&](const Point& x) -> Point { return gradient * x + constant; };
  double work = 0.0, heat = 0.0;
  mpm::momentum_to_grid(in.grid, in.particles, in.model(), in.nodes);
  mpm::particle_pass(in.grid, mpm::LinearWeights{}, in.particles, in.nodes, mpm::every_tile, AddHeatFlow<Dim>{});
  mpm::sum_patches(in.grid, in.nodes.heat_rates);
  in.for_nodes([&](const mpm::NodeAt& at, const Point& position) {
    const Point velocity = velocity_at(position);
    mpm::set_vector<Dim>(in.nodes.velocity(at), 0, velocity);
    mpm::set_vector<Dim>(in.nodes.motion(at), mpm::MotionLayout<Dim>::acceleration, Point(Point::Zero()));
    mpm::set_vector<Dim>(in.nodes.motion(at), mpm::MotionLayout<Dim>::middle_velocity, velocity);
    in.nodes.state(at)[mpm::NodalState::temperature] = heat_gradient.dot(position);
    work += mpm::vector_at<Dim>(in.nodes.momentum(at), mpm::MomentumLayout<Dim>::force).dot(velocity);
    heat += in.nodes.heat_rates(at)[mpm::HeatRates::conduction] * heat_gradient.dot(position);
  });
  double work_of_particles = 0.0, size_of_work = 0.0, heat_of_particles = 0.0, size_of_heat = 0.0;
  for (std::size_t p = 0; p < in.particles.size(); ++p) {
    const auto stress = mpm::full_tensor<Dim>(in.particles.stress, p);
    Matrix<double, 3> full;
    full << stress[0], stress[3], stress[5], stress[3], stress[1], stress[4], stress[5], stress[4], stress[2];
    const Matrix<double, Dim> in_plane = full.template topLeftCorner<Dim, Dim>();
    const double of_particle = -in.particles.volume(p) * in_plane.cwiseProduct(gradient).sum();
    const double of_heat = heat_gradient.dot(in.particles.displacement.template get<Point>(p));
    work_of_particles += of_particle;
    size_of_work += std::abs(of_particle);
    heat_of_particles += of_heat;
    size_of_heat += std::abs(of_heat);
  }
  LinearErrors errors;
  errors.work = std::abs(work - work_of_particles) / (size_of_work + 1.0);
  errors.heat = std::abs(heat - heat_of_particles) / size_of_heat;
  constexpr double dt = 0.01;
  mpm::move_particles(in.grid, in.particles, in.model(), dt, in.nodes);
  const mpm::MomentumWeights<Dim> weights{in.model().shape, in.model().sizes, in.model().sides};
  in.for_nodes([&](const mpm::NodeAt& at, const Point& position) {
    mpm::set_vector<Dim>(in.nodes.velocity(at), 0, velocity_at(position));
  });
  mpm::particle_pass(in.grid, weights, in.particles, in.nodes, mpm::every_tile, ReadVelocity<Dim>{});
  mpm::particle_pass(in.grid, mpm::LinearWeights{}, in.particles, in.nodes, mpm::every_tile, ReadTemperature<Dim>{});
  const double largest_velocity = extent * gradient.cwiseAbs().maxCoeff() + 2.0;
  for (std::size_t p = 0; p < in.particles.size(); ++p) {
    const Point position = in.particles.position.template get<Point>(p);
    const auto update = [](double& largest, double error) { largest = std::max(largest, error); };
    const Point velocity = velocity_at(position);
    update(errors.value,
           (in.particles.velocity.template get<Point>(p) - velocity).cwiseAbs().maxCoeff() / largest_velocity);
    update(errors.displacement,
           (in.particles.step_displacement.template get<Point>(p) / dt - velocity).cwiseAbs().maxCoeff() /
               largest_velocity);
    for (int c = 0; c < Dim * Dim; ++c) {
      update(errors.gradient, std::abs(in.particles.affine_velocity(p, c) - gradient(c % Dim, c / Dim)));
    }
    update(errors.heat_gradient,
           (in.particles.displacement.template get<Point>(p) - heat_gradient).cwiseAbs().maxCoeff());
  }
  return errors;
}

template <int Dim>
void expect_linear_fields(Record& record) {
  Matrix<double, Dim> gradient = Matrix<double, Dim>::Random(), rotation;
  rotation = gradient - gradient.transpose();
  const LinearErrors errors = errors_of_linear_field<Dim>(gradient), turned = errors_of_linear_field<Dim>(rotation);
  const std::string in = Dim == 2 ? ", in the plane" : ", in space";
  record.expect_near("velocity over the largest" + in, std::max(errors.value, errors.displacement), 0.0, 1e-12);
  record.expect_near("velocity gradient" + in, errors.gradient, 0.0, 1e-12);
  record.expect_near("velocity gradient of a rotation" + in, turned.gradient, 0.0, 1e-12);
  record.expect_near("work of stress, of nodes against particles" + in, errors.work, 0.0, 1e-12);
  record.expect_near("work of stress in a rotation" + in, turned.work, 0.0, 1e-12);
  record.expect_near("temperature gradient" + in, errors.heat_gradient, 0.0, 1e-12);
  record.expect_near("heat flow times gradient, of nodes against particles" + in, errors.heat, 0.0, 1e-12);
}

TEST(FollowingCells, ReproduceLinearFields) {
  Record record("Cells that follow the ground: linear fields",
                "Velocity A x + c and temperature g.x at nodes above random ground with slopes up to 6; particles "
                "anywhere, below the ground too.",
                "the field and its gradient at the particles; work of stress -V sigma : A, none in a rotation",
                "kinematics");
  expect_linear_fields<2>(record);
  expect_linear_fields<3>(record);
}

TEST(FollowingCells, RigidTranslationIsKept) {
  Record record("Cells that follow the ground: rigid translation",
                "A body flies freely above ground with waves of 20 m, two cells high.", "constant velocity, no stress",
                "motion without force");
  std::vector<std::vector<double>> waves;
  for (int k = -40; k <= 240; ++k) {
    waves.push_back({5.0 * k, 20.0 * std::sin(0.07 * 5.0 * k)});
  }
  const std::string flying =
      "time.end=10; time.step=0.004; grid.cell=10; grid.min=[-100,-50]; grid.max=[600,150]; "
      "terrain.type=profile; material.rock.youngs_modulus=2e8; material.rock.poisson_ratio=0.2; "
      "body.block.min=[0,60]; body.block.max=[60,100]; body.block.velocity=[40,0]; basal.friction=constant; "
      "basal.friction_angle=0; terrain.file=";
  Simulation<2> simulation(published_case("free", flying + write_profile(waves)));
  run_until(simulation, 2.0);
  const auto& particles = simulation.particles();
  const double change = greatest_of(simulation, [&](std::size_t p) {
    return std::max(std::abs(particles.velocity(p, 0) - 40.0), std::abs(particles.velocity(p, 1)));
  });
  const double stress = greatest_of(
      simulation, [&](std::size_t p) { return mpm::full_tensor<2>(particles.stress, p).cwiseAbs().maxCoeff(); });
  record.expect_near("change of velocity after 500 steps over it", change / 40.0, 0.0, 1e-11);
  record.expect_near("stress over Young's modulus", stress / 2e8, 0.0, 1e-11);
}

}  // namespace
}  // namespace thawslide::verification
