// Freezing of a half space with saturation-dependent conductivity and capacity. There is no closed form, but a
// similarity solution in eta = x/sqrt(t), -(eta/2) C_eff(T) T' = (k(T) T')', found by shooting from the cooled face.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace thawslide::verification {

class FreezingSimilarity {
 public:
  // conductivity(T) [W/m/K], capacity(T) with latent heat [J/m3/K]; the face is at `face`, the far end at `initial` [C]
  // and reached well before eta = `far` [m/s^(1/2)].
  template <class Conductivity, class Capacity>
  FreezingSimilarity(double face, double initial, double far, const Conductivity& conductivity,
                     const Capacity& capacity)
      : step_(far / steps) {
    double low = 0.0, high = 1e5;  // conductivity times T' at the face
    for (int k = 0; k < 80; ++k) {
      const double middle = 0.5 * (low + high);
      const double end = shoot(face, initial, middle, conductivity, capacity);
      (end < initial ? low : high) = middle;
    }
    shoot(face, initial, low, conductivity, capacity);
  }

  // Temperature [C] at depth x [m] and time t [s].
  [[nodiscard]] double temperature(double x, double t) const {
    const double place = x / std::sqrt(t) / step_;
    const auto k = std::min(static_cast<std::size_t>(place), temperature_.size() - 2);
    const double fraction = std::min(1.0, place - static_cast<double>(k));
    return temperature_[k] + fraction * (temperature_[k + 1] - temperature_[k]);
  }

 private:
  // Integrates from the face (Runge and Kutta's fourth-order rule); returns the far temperature, capped above initial.
  template <class Conductivity, class Capacity>
  double shoot(double face, double initial, double flow_at_face, const Conductivity& conductivity,
               const Capacity& capacity) {
    temperature_.assign(1, face);
    double temperature = face, flow = flow_at_face;
    for (int k = 0; k < steps; ++k) {
      const double eta = k * step_;
      const auto slope = [&](double at, double t, double q) {
        const double gradient = q / conductivity(t);
        return std::pair(gradient, -0.5 * at * capacity(t) * gradient);
      };
      const auto [a1, b1] = slope(eta, temperature, flow);
      const auto [a2, b2] = slope(eta + 0.5 * step_, temperature + 0.5 * step_ * a1, flow + 0.5 * step_ * b1);
      const auto [a3, b3] = slope(eta + 0.5 * step_, temperature + 0.5 * step_ * a2, flow + 0.5 * step_ * b2);
      const auto [a4, b4] = slope(eta + step_, temperature + step_ * a3, flow + step_ * b3);
      temperature += step_ / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      flow += step_ / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
      temperature_.push_back(temperature);
      if (temperature > initial + 1.0) {
        return temperature;
      }
    }
    return temperature;
  }

  static constexpr int steps = 20000;
  double step_;
  std::vector<double> temperature_;  // at eta = 0, step, 2 step, ...
};

}  // namespace thawslide::verification
