// V-shaped channels on DEMs: shared by the short and the complete tests.
#pragma once

#include "../support/channel_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification::channel_on_dem {

struct Course {
  double azimuth, aside;  // [degrees], [m]

  [[nodiscard]] std::string text() const {
    return azimuth > 0.0 ? fmt::format("at {} degrees to the grid", azimuth)
           : aside > 0.0 ? "between two grid lines"
                         : "on a grid line";
  }
};

inline double wedge_factor(double opening) { return 1.0 / std::sin(0.5 * opening * pi / 180.0); }

inline Record make_record(const std::string& title) {
  return Record(
      title,
      "An elastic fill, 60 m long, slides in a channel of V section that falls by 35 degrees. The friction angle of "
      "the ground is 15 degrees, cells are 5 m wide, and points of the DEM are 1.25 m apart. Mean from 1 to 3 s.",
      "apparent friction over that of the ground = 1/sin(a), a half the opening angle", "wedge in a groove");
}

// Opening angle [degrees]; width of the fill in cells.
inline void expect_wedge(Record& record, double opening, double cells, const Course& course, double allowed = 0.015) {
  Channel channel = v_channel(0.5 * opening, cells * channel_cell);
  channel.azimuth = course.azimuth;
  channel.aside = course.aside;
  const double found = friction_in_channel(channel, elastic_rock(0.01), 1.0, 3.0);
  record.expect_near(fmt::format("apparent friction over exact, opening {} degrees, {} cells wide, thalweg {}", opening,
                                 cells, course.text()),
                     found / wedge_factor(opening), 1.0, allowed);
}

}  // namespace thawslide::verification::channel_on_dem
