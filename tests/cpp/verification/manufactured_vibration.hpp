// A square that vibrates along its axes with large displacements (Wallstedt and Guilkey 2008), with the body force that
// makes the motion exact for log-strain elasticity.
//   u1 = A sin(2 pi X) sin(c pi t),  u2 = -A sin(2 pi Y) sin(c pi t),  c^2 = E/rho0
//   F11 = 1 + du1/dX,  F22 = 1 + du2/dY;  sigma11 = M ln F11 + lambda ln F22,  M = lambda + 2 mu;  P11 = F22 sigma11
//   rho0 a1 = dP11/dX + rho0 b1  ->  b1 = -c^2 pi^2 u1 + 4 pi^2 u1 M F22/(rho0 F11), and alike for 2
// The unit square lies in the domain's corner at the origin, its sides on rollers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mpm/cell_sums.hpp"
#include "mpm/motion.hpp"
#include "terrain/contact.hpp"

namespace thawslide::sim {

class ManufacturedVibration {
 public:
  using Plane = Vector<double, 2>;
  static constexpr double density = 1000.0, youngs_modulus = 1e7, poisson_ratio = 0.3;

  // cells: along a side; 4 particles per cell.
  ManufacturedVibration(int cells, double amplitude, mpm::ShapeFunction shape, mpm::TransferKind transfer,
                        double pic_fraction)
      : amplitude_(amplitude), grid_(1.0 / cells) {
    model_.shape = shape;
    model_.transfer = transfer;
    model_.pic_fraction = pic_fraction;
    model_.gravity.setZero();
    model_.sizes = {0.25};
    elastic_ = physics::Elastic::from_young_poisson(youngs_modulus, poisson_ratio);
    model_.materials = {{{elastic_, false, 0.0, 0.0}, physics::LinearElastic{}}};
    model_.sides.lower.fill(0);
    model_.sides.upper.fill(cells);
    constraints_.extent = Plane(1.0, 1.0);
    constexpr auto roller = mpm::BoundaryKind::roller;
    constraints_.conditions = {mpm::DomainFaces<2>{constraints_.extent, {roller, roller, roller, roller}}};
    fill(2 * cells);
  }

  void run(double end, double largest_step) {
    const int steps = static_cast<int>(std::ceil(end / largest_step));
    for (int k = 0; k < steps; ++k) {
      step(end / steps);
    }
  }

  // Root mean square displacement error over the particles [m].
  [[nodiscard]] double error() const {
    double sum = 0.0;
    for (std::size_t p = 0; p < particles_.size(); ++p) {
      const auto displacement = particles_.displacement.get<Plane>(p);
      sum += (displacement - exact(start(p))).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(particles_.size()));
  }

  [[nodiscard]] static double period() { return 2.0 / speed(); }
  // Time in which an elastic wave crosses a cell.
  [[nodiscard]] double wave_step() const { return grid_.cell() * std::sqrt(density / elastic_.p_wave_modulus()); }

 private:
  static double speed() { return std::sqrt(youngs_modulus / density); }

  [[nodiscard]] Plane exact(const Plane& position) const {
    const double now = amplitude_ * std::sin(speed() * pi * time_);
    return {now * std::sin(2.0 * pi * position[0]), -now * std::sin(2.0 * pi * position[1])};
  }

  [[nodiscard]] Plane body_force(const Plane& position) const {
    const Plane displacement = exact(position);
    const double now = 2.0 * pi * amplitude_ * std::sin(speed() * pi * time_);
    const double stretch[2] = {1.0 + now * std::cos(2.0 * pi * position[0]),
                               1.0 - now * std::cos(2.0 * pi * position[1])};
    const double stiffness = 4.0 * pi * pi * elastic_.p_wave_modulus() / density;
    const double inertia = speed() * speed() * pi * pi;
    return {displacement[0] * (stiffness * stretch[1] / stretch[0] - inertia),
            displacement[1] * (stiffness * stretch[0] / stretch[1] - inertia)};
  }

  void fill(int rows) {
    particles_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows));
    const double spacing = 1.0 / rows;
    for (std::size_t p = 0; p < particles_.size(); ++p) {
      const auto i = static_cast<int>(p) % rows, j = static_cast<int>(p) / rows;
      const Plane position((i + 0.5) * spacing, (j + 0.5) * spacing);
      const double rate = amplitude_ * speed() * pi;
      particles_.id(p) = static_cast<std::int64_t>(p);
      particles_.volume(p) = spacing * spacing;
      particles_.mass(p) = density * particles_.volume(p);
      particles_.position.set(p, position);
      particles_.velocity.set(p,
                              Plane(rate * std::sin(2.0 * pi * position[0]), -rate * std::sin(2.0 * pi * position[1])));
      particles_.affine_velocity(p, 0) = 2.0 * pi * rate * std::cos(2.0 * pi * position[0]);
      particles_.affine_velocity(p, 3) = -2.0 * pi * rate * std::cos(2.0 * pi * position[1]);
      particles_.porosity(p) = 0.3;
    }
  }

  [[nodiscard]] Plane start(std::size_t p) const {
    return particles_.position.get<Plane>(p) - particles_.displacement.get<Plane>(p);
  }

  void add_body_force() {
    using Layout = mpm::MomentumLayout<2>;
    const auto patches = body_force_.patches(grid_.tiles().size());
    for (std::size_t t = 0; t < grid_.tiles().size(); ++t) {
      patches[t].clear();
      auto sums = mpm::cell_sums<mpm::no_flux, 2>(patches[t]);
      for (const auto& batch : grid_.batches(t)) {
        const auto position = mpm::grid_position(grid_, particles_, batch);
        const auto stencil =
            mpm::make_stencil(model_.shape, grid_, batch, position, model_.sizes.of(particles_, batch), model_.sides);
        mpm::Contribution<2, 2> force;
        for (std::size_t a = 0; a < 2; ++a) {
          force.value[a] = Simd<double>::of([&](std::size_t lane) {
            const std::uint32_t p = batch.particle[lane];
            return particles_.mass(p) * body_force(start(p))[static_cast<int>(a)];
          });
        }
        sums.add(stencil, batch.count, force);
      }
    }
    sum_patches(grid_, body_force_);
    for (std::size_t b = 0; b < grid_.blocks().size(); ++b) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<2>::nodes); ++k) {
        nodes_.momentum(b, k)[Layout::force] += body_force_(b, k)[0];
        nodes_.momentum(b, k)[Layout::force + 1] += body_force_(b, k)[1];
      }
    }
  }

  void step(double dt) {
    grid_.update(particles_, 64);
    mpm::momentum_to_grid(grid_, particles_, model_, nodes_);
    add_body_force();
    const terrain::ContactModel contact;
    const terrain::SlideOnGround<2> without_ground{grid_, nullptr, constraints_, model_, contact, particles_, nodes_};
    terrain::ContactOnCpu<2>().resolve(without_ground, time_, dt);
    mpm::move_particles(grid_, particles_, model_, dt, nodes_);
    terrain::constrain_mapped_back(without_ground, time_, dt);
    mpm::InvalidParticle invalid = mpm::update_stress_and_porosity(grid_, particles_, model_, dt, nodes_).invalid;
    invalid += mpm::update_positions(particles_, Vector<double, 2>(Vector<double, 2>::Zero()), constraints_.extent);
    THAWSLIDE_ASSERT(invalid.id < 0, "particle {} failed at {} s", invalid.id, time_);
    time_ += dt;
  }

  double amplitude_, time_ = 0.0;
  physics::Elastic elastic_;
  mpm::MotionModel<2> model_;
  mpm::Constraints<2> constraints_;
  mpm::Particles<2> particles_;
  mpm::SparseGrid<2> grid_;
  mpm::Nodes<2> nodes_;
  mpm::NodeRecords<2, 2> body_force_{std::make_shared<mpm::PatchPool>()};
};

}  // namespace thawslide::sim

namespace thawslide::verification {

// Shape functions and transfers.
struct Choice {
  std::string name;
  mpm::ShapeFunction shape;
  mpm::TransferKind transfer;
};
const Choice ugimp_flip{"uGIMP, FLIP", mpm::ShapeFunction::ugimp, mpm::TransferKind::flip_pic};
const Choice ugimp_apic{"uGIMP, APIC", mpm::ShapeFunction::ugimp, mpm::TransferKind::apic};
const Choice quadratic_flip{"quadratic, FLIP", mpm::ShapeFunction::quadratic, mpm::TransferKind::flip_pic};
const Choice quadratic_apic{"quadratic, APIC", mpm::ShapeFunction::quadratic, mpm::TransferKind::apic};

// Errors of the maximum displacements, at a quarter of the period, where u = A; relative to A. They contain dt (v(0) -
// v)/2 from Eq. 14, and the step is therefore reduced with the square of the cell.
inline std::vector<double> errors_of(const Choice& choice, double amplitude, const std::vector<int>& cells_per_side) {
  std::vector<double> errors;
  for (const int cells : cells_per_side) {
    sim::ManufacturedVibration square(cells, amplitude, choice.shape, choice.transfer, 0.0);
    square.run(sim::ManufacturedVibration::period() / 4.0, 0.8 / cells * square.wave_step());
    errors.push_back(square.error() / amplitude);
  }
  return errors;
}

const std::string problem = "A unit square between rollers vibrates along its axes, 4 particles per cell, ";
const std::string solution = "u1 = A sin(2 pi X) sin(c pi t), u2 = -A sin(2 pi Y) sin(c pi t), body force to match";
const std::string source = "Wallstedt and Guilkey 2008, for log-strain elasticity";

}  // namespace thawslide::verification
