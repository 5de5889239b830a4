// Direction of the slide and position of its front along x, instantiated for each precision of the step.

#include <cmath>

#include "base/instances.hpp"
#include "sim/departure.hpp"
#include "sim/direction.hpp"
#include "sim/path_line.hpp"

namespace thawslide::sim {

template <int Dim>
double direction_at_start(const Model<Dim>& model, const mpm::Particles<Dim>& particles, double cell) {
  if (Dim == 3) {
    return 1.0;
  }
  Departure departure;
  Extent extent;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto mass = static_cast<double>(particles.mass(p)), speed = static_cast<double>(particles.velocity(p, 0));
    typename terrain::Surface<Dim>::Place place;
    for (int a = 0; a + 1 < Dim; ++a) {
      place[a] = static_cast<double>(particles.position(p, a));
    }
    extent.add(static_cast<double>(particles.position(p, 0)), 0.0);
    departure.add_momentum(mass, speed, std::abs(speed));
    departure.add_force(mass, model.ground ? model.ground->gradient(place, cell)[0] : 0.0,
                        static_cast<double>(model.motion.gravity[0]),
                        -static_cast<double>(model.motion.gravity[Dim - 1]));
  }
  return departure.direction(extent.length()) < 0 ? -1.0 : 1.0;
}

template <int Dim>
double front_along_x(const Simulation<Dim>& simulation, double direction) {
  const PathLine towards_lower_x(config::Polyline2{{0.0, 0.0}, {-1.0, 0.0}});
  return simulation.front(direction < 0.0 ? towards_lower_x.view() : LineView{}).place[0];
}

template <int Dim>
double direction_along_x(const Simulation<Dim>& simulation) {
  if (Dim == 3) {
    return 1.0;
  }
  const double middle = 0.5 * (front_along_x(simulation, 1.0) + front_along_x(simulation, -1.0));
  return middle < simulation.rear_at_start() ? -1.0 : 1.0;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                \
  template double direction_at_start<Dim>(const Model<Dim>&, const mpm::Particles<Dim>&, double); \
  template double direction_along_x<Dim>(const Simulation<Dim>&);                                 \
  template double front_along_x<Dim>(const Simulation<Dim>&, double);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
