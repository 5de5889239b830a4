#include "config/taper_proposal.hpp"

#include <algorithm>
#include <cmath>

namespace thawslide::config {

namespace {

constexpr double least_widths = 3.0, most_widths = 10.0;  // in multiples of the thickness

// Rectangle of points around the release.
struct Window {
  int columns = 0, rows = 0;
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

// Number of steps from each point to the nearest marked one, along rows, columns and diagonals (Rosenfeld and Pfaltz
// 1968).
std::vector<int> steps_to(const std::vector<char>& marked, const Window& window) {
  const int far = window.columns + window.rows;
  std::vector<int> steps(marked.size());
  for (std::size_t k = 0; k < marked.size(); ++k) {
    steps[k] = marked[k] != 0 ? 0 : far;
  }
  const auto pass = [&](int direction) {
    const bool forward = direction > 0;
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.columns; ++c) {
        const int row = forward ? r : window.rows - 1 - r, column = forward ? c : window.columns - 1 - c;
        int& here = steps[window.index(column, row)];
        const auto consider = [&](int i, int j) {
          if (i >= 0 && i < window.columns && j >= 0 && j < window.rows) {
            here = std::min(here, steps[window.index(i, j)] + 1);
          }
        };
        consider(column - direction, row);
        for (int across = -1; across <= 1; ++across) {
          consider(column + across, row - direction);
        }
      }
    }
  };
  pass(1);
  pass(-1);
  return steps;
}

class ReleaseOnDem {
 public:
  // margin: number of DEM points, known or not, around those of the thickness.
  ReleaseOnDem(const Raster& dem, const Raster& thickness, int margin)
      : dem_(dem),
        thickness_(thickness),
        margin_(margin),
        first_column_(first(thickness.x, dem.x, dem.cell_x)),
        first_row_(first(thickness.y, dem.y, dem.cell_y)),
        window_{thickness.columns + 2 * margin, thickness.rows + 2 * margin} {}

  [[nodiscard]] double at(int column, int row) const {
    const int i = column - margin_, j = row - margin_;
    const bool inside = i >= 0 && j >= 0 && i < thickness_.columns && j < thickness_.rows;
    return inside && thickness_.at(i, j) > 0.0 ? thickness_.at(i, j) : 0.0;
  }

  [[nodiscard]] double ground(int column, int row) const {
    const int i = first_column_ + column - margin_, j = first_row_ + row - margin_;
    const bool inside = i >= 0 && j >= 0 && i < dem_.columns && j < dem_.rows;
    return inside ? dem_.at(i, j) : std::nan("");
  }

  // Calls work(column, row) for the points of the window for which `is` returns true.
  template <class Is, class Work>
  void for_each(const Is& is, const Work& work) const {
    for (int row = 0; row < window_.rows; ++row) {
      for (int column = 0; column < window_.columns; ++column) {
        if (is(column, row)) {
          work(column, row);
        }
      }
    }
  }

  template <class Work>
  void for_each_point(const Work& work) const {
    for_each([&](int column, int row) { return at(column, row) > 0.0; }, work);
  }

  [[nodiscard]] std::vector<char> marked(bool in_release) const {
    std::vector<char> marks(window_.index(0, window_.rows), 0);
    for_each([&](int column, int row) { return (at(column, row) > 0.0) == in_release; },
             [&](int column, int row) { marks[window_.index(column, row)] = 1; });
    return marks;
  }

  [[nodiscard]] const Window& window() const { return window_; }

 private:
  static int first(double coordinate, double origin, double cell) {
    return static_cast<int>(std::lround((coordinate - origin) / cell));
  }

  const Raster& dem_;
  const Raster& thickness_;
  int margin_, first_column_, first_row_;
  Window window_;
};

// Maximum thickness at points next to the edge; the outline may cut the cells of the edge points themselves.
double edge_thickness(const ReleaseOnDem& release, const std::vector<int>& steps_inside) {
  double largest = 0.0;
  release.for_each_point([&](int column, int row) {
    if (steps_inside[release.window().index(column, row)] <= 2) {
      largest = std::max(largest, release.at(column, row));
    }
  });
  return largest;
}

double mean_slope(const ReleaseOnDem& release, const Raster& dem) {
  double x = 0.0, y = 0.0, points = 0.0;
  release.for_each_point([&](int column, int row) {
    const double dx = release.ground(column + 1, row) - release.ground(column - 1, row);
    const double dy = release.ground(column, row + 1) - release.ground(column, row - 1);
    if (!std::isnan(dx + dy)) {
      x += dx / (2.0 * dem.cell_x);
      y += dy / (2.0 * dem.cell_y);
      points += 1.0;
    }
  });
  return points > 0.0 ? std::hypot(x, y) / points : 0.0;
}

}  // namespace

double slope_below(const Raster& dem, const Raster& thickness) {
  return mean_slope(ReleaseOnDem(dem, thickness, 1), dem);
}

EdgeTaper propose_taper(const Raster& dem, const Raster& thickness) {
  const double cell = std::min(dem.cell_x, dem.cell_y);
  const double thickest = *std::max_element(thickness.values.begin(), thickness.values.end());
  const ReleaseOnDem release(dem, thickness, 2 + static_cast<int>(std::ceil(0.5 * most_widths * thickest / cell)));
  const Window& window = release.window();

  const std::vector<int> inside = steps_to(release.marked(false), window);
  const std::vector<int> outside = steps_to(release.marked(true), window);
  int to_unknown = window.columns + window.rows;
  release.for_each([&](int column, int row) { return std::isnan(release.ground(column, row)); },
                   [&](int column, int row) { to_unknown = std::min(to_unknown, outside[window.index(column, row)]); });
  const int half_width = *std::max_element(inside.begin(), inside.end());

  EdgeTaper taper;
  taper.slope = mean_slope(release, dem);
  const double edge = edge_thickness(release, inside);
  const double wanted = std::clamp(2.0 * edge / std::max(taper.slope, 1e-9), least_widths * edge, most_widths * edge);
  const double wanted_cells = std::ceil(wanted / cell - 1e-9);
  // An upright edge between DEM points is a ramp one cell wide, as steep as a taper of two cells.
  taper.wanted = wanted_cells > 2.0 ? wanted_cells * cell : 0.0;
  const double available = std::max(0.0, std::min(2.0 * (to_unknown - 1), 2.0 * (half_width - 1)) * cell);
  const double width = std::min(taper.wanted, available);
  taper.width = width > 2.0 * cell ? width : 0.0;
  taper.steepest = 2.0 * edge / std::max(taper.width, 2.0 * cell);
  return taper;
}

}  // namespace thawslide::config
