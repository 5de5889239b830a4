// Where which substrate lies: kinds of ground, by number from 1, over the horizontal plane. Where none lies it is 0.
#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "base/raster.hpp"

namespace thawslide::terrain {

class Substrates {
 public:
  using Ring = std::vector<std::array<double, 2>>;  // closed: the last corner is the first one

  // Origin: the domain's lower corner [m]. Areas are told in absolute coordinates, places are relative to it.
  explicit Substrates(const std::array<double, 2>& origin) : origin_(origin) {}

  // Everywhere from one x to another, which may be infinite; its beginning belongs to it, its end does not.
  void add_strip(int number, double from, double to);
  // Within outlines and not in their holes: an odd number of rings is about it.
  void add_rings(int number, const std::vector<Ring>& rings);
  // In the cells about those points of a raster that hold a code.
  void add_code(int number, std::shared_ptr<const Raster> codes, double code);

  // The number at a place; the one added first where there are several. y counts in three dimensions only.
  [[nodiscard]] int at(double x, double y) const;

 private:
  struct Strip {
    double from, to;
    [[nodiscard]] bool holds(double x, double y) const;
  };
  struct Edge {
    std::array<double, 2> low, high;  // by y
  };
  // Edges by the belts of y that they cross, so that a place asks few of them.
  struct Rings {
    double first = 0.0, width = 1.0;  // of the belts [m]
    std::vector<std::vector<Edge>> belts;
    [[nodiscard]] bool holds(double x, double y) const;
  };
  struct Code {
    std::shared_ptr<const Raster> codes;
    double code;
    [[nodiscard]] bool holds(double x, double y) const;
  };
  struct Area {
    int number;
    std::variant<Strip, Rings, Code> where;
  };
  std::array<double, 2> origin_;
  std::vector<Area> areas_;
};

}  // namespace thawslide::terrain
