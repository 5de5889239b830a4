// A body that map files give: it stands on the ground, as thick as they say.
#pragma once

#include <map>
#include <string>

#include "base/raster_sampling.hpp"
#include "config/site.hpp"
#include "sim/seed.hpp"
#include "terrain/surface.hpp"

namespace thawslide::sim {

// Value of the point nearest to a place, of those that have one; throws UserError if none of the next few has.
double nearest_value(const Raster& raster, double x, double y);

class ReleaseBody {
 public:
  using Releases = std::map<std::string, config::Release>;

  // releases: of all bodies, with that of `name`. origin: of the ground's coordinates [m]. Releases and ground must
  // outlive the body.
  ReleaseBody(const Releases& releases, const std::string& name, const terrain::Surface<3>& ground,
              const Vector<double, 3>& origin)
      : releases_(&releases), release_(&releases.at(name)), ground_(&ground), origin_(origin) {}

  [[nodiscard]] double volume() const { return volume_of(release_->thickness); }
  // Elevation of the ground below a place, and whether the body is there [m].
  [[nodiscard]] double bottom(double x, double y) const;
  [[nodiscard]] bool contains(const Vector<double, 3>& place) const;

  // Columns of particles, `spacing` [m] apart on the lattice of `corner`: as many in each as fit its thickness best,
  // of equal height from the ground to the top, and of the volume of their share of it. So the lowest stand on the
  // ground everywhere. Columns thinner than a tenth of the spacing get none, nor those whose centre is another body's.
  void seed(const Vector<double, 3>& corner, double spacing, int body, std::vector<Seed<3>>& seeds) const;

 private:
  // Vertical [m], in the body's own part.
  [[nodiscard]] const Raster& thickness() const {
    return release_->standing.empty() ? release_->thickness : release_->standing;
  }
  [[nodiscard]] double mean_thickness(double x, double y, double width) const;
  // Whether a place is not another body's, as config::Release says.
  [[nodiscard]] bool owns(double x, double y) const;

  const Releases* releases_;
  const config::Release* release_;
  const terrain::Surface<3>* ground_;
  Vector<double, 3> origin_;
};

}  // namespace thawslide::sim
