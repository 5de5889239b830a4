// Collapse of a column of aluminium bars next to a wall, compared with measurements.
#pragma once

#include <fstream>

#include "verification.hpp"

namespace thawslide::verification::bar_collapse {

// Parameters published with the measurements; E = 3 K (1 - 2 nu) with K = 0.7 MPa. Material in contact with the rough
// floor does not slide: the friction angle of the floor is far above that of the bars.
inline const Sets column{"time.end=1; grid.min=[0,-0.04]; grid.max=[0.8,0.2]; phases.rock_density=2650",
                         "material.sand.youngs_modulus=0.84e6; material.sand.friction_angle=19.8",
                         "body.column.max=[0.2,0.1]; body.column.porosity=1e-9; basal.friction_angle=80"};

struct Line {
  std::vector<double> x, height;  // [m]
};

// Measured line by name: "surface" after the collapse, or "failure", the limit between moved and unmoved material.
inline Line measured(const std::string& name) {
  std::ifstream file(THAWSLIDE_SOURCE_DIR "/tests/cpp/verification/bar_collapse/" + name + ".csv");
  Line line;
  for (std::string text; std::getline(file, text);) {
    if (text.find_first_of("0123456789") == 0) {
      const std::size_t comma = text.find(',');
      line.x.push_back(std::stod(text.substr(0, comma)));
      line.height.push_back(std::stod(text.substr(comma + 1)));
    }
  }
  EXPECT_GT(line.x.size(), 8U) << name;
  return line;
}

inline constexpr double window = 0.01;           // averaging length of the computed lines along x [m]
inline constexpr double toe_thickness = 0.0015;  // of the measured surface at its last point, x = 0.442 m [m]
inline constexpr double moved = 0.001;           // displacement of moved material [m]

// The column on cells of `cell` [m] at the end of its collapse.
class Collapse {
 public:
  Collapse(double cell, const std::string& transfer)
      : cell_(cell),
        simulation_(base_case("sand", column + Sets(fmt::format("grid.cell={}; time.step={}; mechanics.transfer={}",
                                                                cell, 0.0194 * cell, transfer)))) {
    run_until(simulation_, 1.0);
  }

  // Thickness at x [m]: area of the material within the window, at the density before the collapse, over its width.
  [[nodiscard]] double thickness(double x) const {
    const auto& particles = simulation_.particles();
    const double from = std::max(0.0, x - 0.5 * window), to = x + 0.5 * window, half = 0.25 * cell_;
    double area = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double at = particles.position(p, 0);
      const double within = std::min(at + half, to) - std::max(at - half, from);
      area += particles.initial_volume(p) * std::max(0.0, within) / (2.0 * half);
    }
    return area / (to - from);
  }

  // Largest x at which the slide is as thick as the measured toe [m].
  [[nodiscard]] double toe() const {
    double x = 0.8;
    while (thickness(x) < toe_thickness) {
      x -= 0.001;
    }
    return x;
  }

  // Height at x [m] above which material has moved. Displacements of rows of particles are averaged over the window
  // and interpolated linearly between rows.
  [[nodiscard]] double failure(double x) const {
    const auto& particles = simulation_.particles();
    const double spacing = 0.5 * cell_;
    std::vector<double> sum(static_cast<std::size_t>(std::lround(0.1 / spacing))), count(sum.size());
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const auto displacement = particles.displacement.get<Vector<double, 2>>(p);
      const Vector<double, 2> start = particles.position.get<Vector<double, 2>>(p) - displacement;
      if (std::abs(start[0] - x) <= 0.5 * window) {
        const auto row = static_cast<std::size_t>((start[1] - ground()) / spacing);
        sum.at(row) += displacement.norm();
        count.at(row) += 1.0;
      }
    }
    double below = 0.0, height = 0.0;  // the ground, which does not move
    for (std::size_t row = 0; row < sum.size(); ++row) {
      const double here = sum[row] / count[row], middle = (static_cast<double>(row) + 0.5) * spacing;
      if (here > moved) {
        return height + (moved - below) / (here - below) * (middle - height);
      }
      below = here;
      height = middle;
    }
    return 0.1;
  }

 private:
  [[nodiscard]] double ground() const { return -simulation_.model().origin[1]; }

  double cell_;
  Simulation<2> simulation_;
};

inline std::vector<double> surface_of(const Collapse& collapse, const std::vector<double>& places) {
  return each_of(places, [&](double x) { return collapse.thickness(x); });
}

// Found minus expected [mm].
inline std::vector<double> differences(const std::vector<double>& found, const std::vector<double>& expected) {
  std::vector<double> all(found.size());
  std::transform(found.begin(), found.end(), expected.begin(), all.begin(),
                 [](double a, double b) { return 1e3 * (a - b); });
  return all;
}

// Allowed deviations [mm] of the surface (root mean square and largest), the toe and the failure line.
struct Allowed {
  double surface, largest, toe, failure;
};

inline Allowed allowed_on(double cell, const std::string& transfer) {
  if (transfer == "flip") {
    return cell > 0.007   ? Allowed{4.0, 12.0, 50.0, 7.0}
           : cell > 0.004 ? Allowed{3.2, 8.0, 30.0, 8.0}
                          : Allowed{4.5, 9.0, 50.0, 9.5};
  }
  return cell > 0.007   ? Allowed{4.5, 13.0, 100.0, 6.0}
         : cell > 0.004 ? Allowed{2.5, 5.0, 60.0, 6.0}
                        : Allowed{3.2, 6.5, 30.0, 8.0};
}

// Returns the computed surface at the measured places.
inline std::vector<double> expect_measured(Record& record, double cell, const std::string& transfer, bool drawn) {
  const Allowed allowed = allowed_on(cell, transfer);
  const Line surface = measured("surface"), failure = measured("failure");
  const Collapse collapse(cell, transfer);
  const std::vector<double> top = surface_of(collapse, surface.x),
                            limit = each_of(failure.x, [&](double x) { return collapse.failure(x); });
  const std::string run = fmt::format("cells of {:g} mm, {}", 1e3 * cell, transfer);
  const std::vector<double> off = differences(top, surface.height);
  record.expect_near("surface less measured, root mean square [mm], " + run, root_mean_square(off), 0.0,
                     allowed.surface);
  record.expect_near("surface less measured, largest size [mm], " + run,
                     std::max(*std::max_element(off.begin(), off.end()), -*std::min_element(off.begin(), off.end())),
                     0.0, allowed.largest);
  record.expect_near("toe [mm], " + run, 1e3 * collapse.toe(), 442.0, allowed.toe);
  record.expect_near("failure line less measured, root mean square [mm], " + run,
                     root_mean_square(differences(limit, failure.height)), 0.0, allowed.failure);
  if (drawn) {
    record.draw({"x [m]", "surface [m], " + run, surface.x, top, surface.height, "measured"});
    record.draw({"x [m]", "failure line [m]", failure.x, limit, failure.height, "measured"});
  }
  return top;
}

inline Record make_record(const std::string& title) {
  return Record(
      title,
      "A column of aluminium bars, 0.2 m wide and 0.1 m high, collapses next to a smooth wall on a floor without "
      "sliding. The bars have a friction angle of 19.8 degrees, no cohesion, no dilation, 2650 kg/m3, bulk modulus 0.7 "
      "MPa and Poisson's ratio 0.3. Nothing is fitted. The surface is the area of the material over windows of 10 mm, "
      "and the toe is where it is 1.5 mm thick. Material has failed if it has moved by 1 mm.",
      "measured surface and failure line",
      "LandslideSIM/MaterialPointSolver.jl, MIT licence; experiment of Bui et al. 2008 (inferred)");
}

}  // namespace thawslide::verification::bar_collapse
