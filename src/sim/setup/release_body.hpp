// Body specified by map files: it rests on the ground with the mapped thickness.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/site.hpp"
#include "sim/setup/model.hpp"
#include "sim/setup/seed.hpp"
#include "terrain/surface.hpp"

namespace thawslide::sim {

// Value of the nearest raster point that has one; throws UserError if none of the adjacent points has one.
double nearest_value(const Raster& raster, double x, double y);

// Corners that bound a release in the map: those of its outlines, or of the cells of its raster.
[[nodiscard]] config::Polyline2 corners_of(const config::Release& release);

// Elevation of the highest point of a release on the ground [m].
[[nodiscard]] double top_of(const config::Release& release, const Raster& ground);

class ReleaseBody {
 public:
  using Releases = std::map<std::string, config::Release>;

  // releases: of all bodies, including that of `name`. origin: of the ground's coordinates [m]. Releases and ground
  // must outlive the body.
  ReleaseBody(const Releases& releases, const std::string& name, const terrain::Surface<3>& ground,
              const Vector<double, 3>& origin)
      : releases_(&releases), release_(&releases.at(name)), ground_(&ground), origin_(origin) {}

  [[nodiscard]] double volume() const { return volume_of(release_->thickness); }
  // Ground elevation below a point [m], and membership of a point in the body.
  [[nodiscard]] double bottom(double x, double y) const;
  [[nodiscard]] bool contains(const Vector<double, 3>& point) const;

  // Seeds columns of particles, `spacing` [m] apart on the lattice of `corner`. Each column has the number of particles
  // that best fits its thickness, of equal height from the ground to the top and of equal volume. The lowest particles
  // therefore rest on the ground everywhere. Columns thinner than a tenth of the spacing, and columns whose centre
  // belongs to another body, get no particles.
  void seed(const Vector<double, 3>& corner, double spacing, int body, std::vector<Seed<3>>& seeds) const;

 private:
  // Vertical thickness [m], in the body's own part.
  [[nodiscard]] const Raster& thickness() const {
    return release_->assigned_thickness.empty() ? release_->thickness : release_->assigned_thickness;
  }
  [[nodiscard]] double mean_thickness(double x, double y, double width) const;
  // True if the place belongs to no other body, as defined in config::Release.
  [[nodiscard]] bool owns(double x, double y) const;

  const Releases* releases_;
  const config::Release* release_;
  const terrain::Surface<3>* ground_;
  Vector<double, 3> origin_;
};

// Release in stages: a body is held until its release time. Held bodies have separate nodes, which are fixed.

// Release times of a number of bodies [s], in the order of the case; 0 for those that the case does not contain. Empty
// if all bodies are released at the start.
[[nodiscard]] std::vector<double> release_times(const config::Case& parameters, const config::Site& site,
                                                std::size_t bodies);

// True until the release time of a body. times: by body, or empty. A step that ends at the release time to round-off
// releases the body.
[[nodiscard]] bool is_held(const std::vector<double>& times, double time, std::size_t body);

// Time of the next release [s]; infinite if no body is held.
[[nodiscard]] double next_release(const std::vector<double>& times, double time);

// Layers of the grid by body, with separate ones for held bodies.
template <int Dim>
[[nodiscard]] std::vector<std::uint8_t> layers_of_bodies(const Model<Dim>& model, double time) {
  const mpm::BetweenBodies& between = model.between_bodies;
  std::vector<std::uint8_t> layers = between.layer_of_body;
  for (std::size_t body = 0; body < layers.size(); ++body) {
    layers[body] =
        static_cast<std::uint8_t>(layers[body] + (is_held(model.release_times, time, body) ? between.layers : 0));
  }
  return layers;
}

}  // namespace thawslide::sim
