#include "terrain/substrates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thawslide::terrain {

void Substrates::add_strip(int number, double from, double to) { areas_.push_back({number, Strip{from, to}}); }

void Substrates::add_rings(int number, const std::vector<Ring>& rings) {
  std::vector<Edge> edges;
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Ring& ring : rings) {
    for (std::size_t k = 1; k < ring.size(); ++k) {
      // A fixed order of the ends makes the side of an edge identical for both neighbours that share it.
      const auto [low, high] = std::minmax(ring[k - 1], ring[k], [](const auto& one, const auto& other) {
        return std::pair(one[1], one[0]) < std::pair(other[1], other[0]);
      });
      edges.push_back({low, high});
      lowest = std::min(lowest, low[1]);
      highest = std::max(highest, high[1]);
    }
  }
  if (!(lowest < highest)) {
    return;
  }
  Rings found;
  const std::size_t count = std::max<std::size_t>(1, edges.size() / 2);
  found.first = lowest;
  found.width = (highest - lowest) / static_cast<double>(count);
  found.belts.resize(count);
  const auto belt_of = [&](double y) {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, (y - found.first) / found.width)));
  };
  for (const Edge& edge : edges) {
    for (std::size_t belt = belt_of(edge.low[1]); belt <= belt_of(edge.high[1]); ++belt) {
      found.belts[belt].push_back(edge);
    }
  }
  areas_.push_back({number, std::move(found)});
}

void Substrates::add_code(int number, std::shared_ptr<const Raster> codes, double code) {
  areas_.push_back({number, Code{std::move(codes), code}});
}

int Substrates::at(double x, double y) const {
  x += origin_[0];
  y += origin_[1];
  for (const Area& area : areas_) {
    if (std::visit([&](const auto& where) { return where.contains(x, y); }, area.where)) {
      return area.number;
    }
  }
  return 0;
}

bool Substrates::Strip::contains(double x, double /*y*/) const { return x >= from && x < to; }

bool Substrates::Rings::contains(double x, double y) const {
  const double belt = std::floor((y - first) / width);
  if (!(belt >= 0.0 && belt <= static_cast<double>(belts.size()))) {
    return false;
  }
  bool inside = false;
  for (const Edge& edge : belts[std::min(belts.size() - 1, static_cast<std::size_t>(belt))]) {
    if (edge.low[1] <= y && y < edge.high[1]) {
      const double fraction = (y - edge.low[1]) / (edge.high[1] - edge.low[1]);
      inside ^= x < edge.low[0] + fraction * (edge.high[0] - edge.low[0]);
    }
  }
  return inside;
}

bool Substrates::Code::contains(double x, double y) const {
  const double column = std::floor((x - codes->x) / codes->cell_x + 0.5);
  const double row = std::floor((y - codes->y) / codes->cell_y + 0.5);
  return column >= 0.0 && row >= 0.0 && column < codes->columns && row < codes->rows &&
         codes->at(static_cast<int>(column), static_cast<int>(row)) == code;
}

}  // namespace thawslide::terrain
