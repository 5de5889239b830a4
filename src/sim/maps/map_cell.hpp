// Map cell: sums over the boxes above it in one step, and the maxima of the run.
//    h = V/A,  v = p/m,  rho = m/V     averages over the column (Savage and Hutter 1989)
//    h v2                              momentum flux per metre of width across the flow, divided by density
//    rho v2                            pressure on a wide wall that stops the flow (balance of momentum)
// V, m, p: volume [m3], mass [kg] and momentum [kg m/s] of the slide over the cell; A: the cell's area [m2].
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "mpm/map_sums.hpp"

namespace thawslide::sim {

// Thickness h [m] of a volume V [m3] over a cell of area A [m2].
[[nodiscard]] inline double thickness_of(double volume, double area) { return volume / area; }
// h v2 [m3/s2].
[[nodiscard]] inline double momentum_flux(double thickness, double speed) { return thickness * speed * speed; }
// rho v2 [Pa].
[[nodiscard]] inline double dynamic_pressure(double density, double speed) { return density * speed * speed; }

// Map cell during a run. Maxima are NaN until first recorded.
struct MapCell {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  double thickness_at_start = 0.0;                              // [m]
  double thickness = 0.0;                                       // current [m]
  double velocity_x = 0.0, velocity_y = 0.0, velocity_z = 0.0;  // current, depth-averaged [m/s]
  double max_thickness = 0.0;                                   // [m]; 0: the slide never reached the cell
  double max_speed = none;                                      // [m/s]
  double max_momentum_flux = none;                              // [m3/s2]
  double max_pressure = none;                                   // [Pa]
  double max_pressure_time = none;                              // [s]
  double arrival_time = none;                                   // [s]
  double max_basal_temperature = none;                          // [C]
  double max_melt = 0.0;                                        // depth of water [m]
  double max_pore_pressure = none;                              // [Pa]

  [[nodiscard]] double speed() const {
    return std::sqrt(velocity_x * velocity_x + velocity_y * velocity_y + velocity_z * velocity_z);
  }

  // Nothing lies over the cell; its maxima remain.
  void clear() { thickness = velocity_x = velocity_y = velocity_z = 0.0; }

  // Records the state at a time [s]. area: of the cell [m2]; arrival_thickness [m]: thinner flow is not recorded,
  // because its speed and pressure are those of single particles.
  void update(const mpm::ColumnSums& sums, const mpm::BandSums& band, double area, double arrival_thickness,
              double time) {
    if (!(sums.volume > 0.0)) {
      clear();
      return;
    }
    thickness = thickness_of(sums.volume, area);
    const double inverse_mass = 1.0 / sums.mass;
    velocity_x = sums.momentum_x * inverse_mass;
    velocity_y = sums.momentum_y * inverse_mass;
    velocity_z = sums.momentum_z * inverse_mass;
    const double speed_now = speed();
    raise(max_thickness, thickness);
    raise(max_momentum_flux, momentum_flux(thickness, speed_now));
    raise(max_melt, thickness_of(sums.water, area));
    if (thickness > arrival_thickness) {
      raise(max_speed, speed_now);
      if (raise(max_pressure, dynamic_pressure(sums.mass / sums.volume, speed_now))) {
        max_pressure_time = time;
      }
      if (std::isnan(arrival_time)) {
        arrival_time = time;
      }
    }
    if (band.volume > 0.0) {
      raise(max_basal_temperature, band.volume_temperature / band.volume);
      raise(max_pore_pressure, band.volume_pressure / band.volume);
    }
  }

 private:
  // Returns true if the value exceeds the record, which it then becomes.
  static bool raise(double& record, double value) {
    const bool exceeds = !(record >= value);
    record = exceeds ? value : record;
    return exceeds;
  }
};

// Map cell as plain numbers, for a checkpoint.
constexpr std::size_t map_cell_numbers = sizeof(MapCell) / sizeof(double);
using MapCellNumbers = std::array<double, map_cell_numbers>;
[[nodiscard]] inline MapCellNumbers numbers_of(const MapCell& cell) { return std::bit_cast<MapCellNumbers>(cell); }
[[nodiscard]] inline MapCell map_cell_of(const MapCellNumbers& numbers) { return std::bit_cast<MapCell>(numbers); }

}  // namespace thawslide::sim
