// The thickness of the slide is independent of the position of grid lines.
#include "band/flow_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thawslide::band {
namespace {

constexpr double cell = 10.0;
constexpr double spacing = 5.0;  // of particles
constexpr std::size_t layers = 6;

// A box of `length` particles along each horizontal axis and `layers` vertically, with its lower corner at `from` [m];
// the lowest layer is the band, `bulge` [m] ahead of the others.
template <int Dim>
void fill_box(std::size_t length, std::size_t layers, double from, double bulge, mpm::Particles<Dim>& box) {
  std::size_t columns = 1;
  for (int a = 0; a + 1 < Dim; ++a) {
    columns *= length;
  }
  box.resize(columns * layers);
  for (std::size_t p = 0; p < box.size(); ++p) {
    std::size_t place = p % columns;
    const std::size_t layer = p / columns;
    box.id(p) = static_cast<std::int64_t>(p);
    box.volume(p) = std::pow(spacing, Dim);
    box.in_band(p) = layer == 0 ? 1 : 0;
    for (int a = 0; a + 1 < Dim; ++a) {
      box.position(p, a) =
          from + (static_cast<double>(place % length) + 0.5) * spacing + (a == 0 && layer == 0 ? bulge : 0.0);
      place /= length;
    }
    box.position(p, Dim - 1) = (static_cast<double>(layer) + 0.5) * spacing;
  }
}

// A box on its grid, and the model of its particles.
template <int Dim>
struct BoxOnGrid {
  mpm::Particles<Dim> box;
  mpm::SparseGrid<Dim> grid{cell};
  BandModel<Dim> model;

  BoxOnGrid(double from, double bulge) {
    fill_box<Dim>(7, layers, from, bulge, box);
    for (std::size_t p = 0; p < box.size(); ++p) {
      box.mass(p) = 2000.0 * box.volume(p);
    }
    grid.update(box, 1);
    model.sizes = {0.5 * spacing / cell};
  }
};

template <int Dim>
void expect_thickness(double from, double bulge, double allowed) {
  BoxOnGrid<Dim> scene(from, bulge);
  auto& [box, grid, model] = scene;
  FlowDepth<Dim> depth;
  depth.update(grid, model, {}, {}, box);
  depth.depth_to_particles(grid, box);
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    const auto columns = depth.by_tile().of_tile(t);
    for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const double below_top = layers * spacing - box.position(p, Dim - 1);
      EXPECT_NEAR(columns.below_top(box, mpm::batch_in_memory(p, p + 1))[0], below_top, 1e-9)
          << "box from " << from << ", particle " << p;
      EXPECT_NEAR(box.flow_depth(p), box.in_band(p) != 0 ? layers * spacing : below_top, allowed)
          << "box from " << from << ", particle " << p;
    }
  }
}

TEST(FlowDepth, IsThatOfTheBoxAtAnyPosition) {
  for (const double from : {-3.0, 0.0, 1e-12, 0.7, 2.5, 3.6, 5.0 - 1e-12, 5.0, 7.5, 9.999}) {
    expect_thickness<2>(from, 0.0, 1e-9);
    expect_thickness<3>(from, 0.0, 1e-9);
  }
}

// N of the columns and its change, on ground with a slope cosine of 0.8, with 0.6 of gravity.
template <int Dim>
void expect_load(double from) {
  BoxOnGrid<Dim> scene(from, 0.0);
  auto& [box, grid, model] = scene;
  FlowDepth<Dim> depth;
  const auto normal_gravity = [](const Vector<double, Dim - 1>& /*place*/) { return 0.8 * 0.6 * 9.81; };
  for (const double thinning : {1.0, 0.25}) {
    for (std::size_t p = 0; p < box.size(); ++p) {
      box.mass(p) *= thinning;
    }
    depth.update(grid, model, {}, normal_gravity, box);
    depth.load_to_particles(grid, box);
    for (std::size_t p = 0; p < box.size(); ++p) {
      const double above = box.in_band(p) != 0 ? layers * spacing : layers * spacing - box.position(p, Dim - 1);
      const double load = thinning * 2000.0 * 0.48 * 9.81 * above;
      EXPECT_NEAR(box.normal_load(p), load, 1e-6) << "box from " << from << ", particle " << p;
      EXPECT_NEAR(box.load_change(p), thinning < 1.0 ? -3.0 * load : load, 1e-6);
    }
  }
}

TEST(FlowDepth, GivesTheLoadOfTheBoxAtAnyPosition) {
  for (const double from : {-3.0, 0.0, 0.7, 2.5, 5.0, 9.999}) {
    expect_load<2>(from);
    expect_load<3>(from);
  }
}

// When the front passes a grid line, the foremost particle of the band is alone in a column. Its own top must not count
// as the surface.
TEST(FlowDepth, IncludesTheBodyAboveABandThatIsAhead) {
  for (double from = 0.0; from < 10.0; from += 0.1) {
    expect_thickness<2>(from, 0.02, 0.3);
    expect_thickness<3>(from, 0.02, 0.3);
  }
}

}  // namespace
}  // namespace thawslide::band
