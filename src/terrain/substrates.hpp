// Substrates over the horizontal plane, by number from 1; 0 elsewhere.
#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "base/raster.hpp"

namespace thawslide::terrain {

class Substrates {
 public:
  using Ring = std::vector<std::array<double, 2>>;  // closed: the last corner equals the first one

  // origin: the domain's lower corner [m]. Areas are given in absolute coordinates, places relative to the origin.
  explicit Substrates(const std::array<double, 2>& origin) : origin_(origin) {}

  // Strip from one x to another, each possibly infinite. It includes its beginning but not its end.
  void add_strip(int number, double from, double to);
  // Area inside outlines and outside their holes: enclosed by an odd number of rings.
  void add_rings(int number, const std::vector<Ring>& rings);
  // Cells around the points of a raster that have a code.
  void add_code(int number, std::shared_ptr<const Raster> codes, double code);

  // Number at a place; of overlapping areas, the one added first. y is used in 3D only.
  [[nodiscard]] int at(double x, double y) const;

 private:
  struct Strip {
    double from, to;
    [[nodiscard]] bool contains(double x, double y) const;
  };
  struct Edge {
    std::array<double, 2> low, high;  // by y
  };
  // Edges grouped by the belts of y that they cross, to test only a few edges per place.
  struct Rings {
    double first = 0.0, width = 1.0;  // of the belts [m]
    std::vector<std::vector<Edge>> belts;
    [[nodiscard]] bool contains(double x, double y) const;
  };
  struct Code {
    std::shared_ptr<const Raster> codes;
    double code;
    [[nodiscard]] bool contains(double x, double y) const;
  };
  struct Area {
    int number;
    std::variant<Strip, Rings, Code> where;
  };
  std::array<double, 2> origin_;
  std::vector<Area> areas_;
};

}  // namespace thawslide::terrain
