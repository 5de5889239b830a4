// Map data of a case: ground, and fields of bodies on it. Read by the gis module. Also the profile of a 2D case.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/profile_csv.hpp"

namespace thawslide::config {

using Polyline2 = std::vector<std::array<double, 2>>;  // x, y [m] of the corners

struct Release {
  Raster thickness;           // vertical [m] at the points of the ground's raster, cropped to the release; 0 outside
  double area = 0.0;          // horizontal, of the outlines [m2]
  double release_time = 0.0;  // [s], if an attribute of the polygons specifies it
  std::vector<Polyline2> outlines;       // closed rings, for figures; empty if a raster specifies the release
  std::map<std::string, Raster> fields;  // by key of the body: "temperature", "porosity", ... if given by a map
  // Only for a body that touches others. A point belongs to the outline around it, or beyond all to the largest claim.
  Raster assigned_thickness;  // vertical thickness [m] in the body's own part, without an edge towards the others
  Raster claim;  // fraction of each point's cell within the outline; beyond all outlines, within reach of its taper
};

// Calls visit(column, row) for the points of positive thickness.
template <class Visit>
void for_points_of_release(const Raster& thickness, const Visit& visit) {
  for (int row = 0; row < thickness.rows; ++row) {
    for (int column = 0; column < thickness.columns; ++column) {
      if (thickness.at(column, row) > 0.0) {
        visit(column, row);
      }
    }
  }
}

// Extent of a substrate from maps.
struct SubstrateArea {
  std::vector<Polyline2> rings;         // closed: outlines and their holes; empty for a raster
  std::shared_ptr<const Raster> codes;  // null for polygons
  double code = 0.0;                    // of the raster
  double area = 0.0;                    // horizontal, within the domain [m2]
};

// Part of a section with a substrate, from one x to another [m].
struct SubstrateStretch {
  std::string name;
  double from, to;
};

// Noise and short bumps of a DEM, and the filter applied to them.
struct Roughness {
  double noise = 0.0;              // rms of white noise of equal roughness on points `spacing` apart [m]
  double spacing = 0.0;            // [m]
  double cell = 0.0;               // of the grid [m]
  double bump_length = 0.0;        // maximum length of bumps that count [m]
  double bump_slope = 0.0;         // rms slope of these bumps without the filter
  double width = 0.0;              // standard deviation of the filter [m]; 0: none
  double remaining_slope = 0.0;    // rms slope of noise or bumps at the scale of the cell, after the filter
  double apparent_friction = 0.0;  // that it adds, as a fraction of the friction
  double narrow_valley = 0.0;      // width below which the filter reduces the wedge effect of valleys [m]
};

// By the names used in JSON files.
using NamedFigures = std::vector<std::pair<std::string, double>>;
[[nodiscard]] inline NamedFigures named(const Roughness& ground) {
  return {{"noise_m", ground.noise},
          {"noise_cells", ground.noise / ground.cell},
          {"spacing_m", ground.spacing},
          {"bump_length_m", ground.bump_length},
          {"bump_slope", ground.bump_slope},
          {"filter_m", ground.width},
          {"remaining_slope", ground.remaining_slope},
          {"apparent_friction", ground.apparent_friction},
          {"narrow_valley_m", ground.narrow_valley}};
}

struct Site {
  std::shared_ptr<const Raster> ground;            // sliding surface, after excavation of releases; null: no raster
  std::shared_ptr<const Raster> before_smoothing;  // at the same points, without excavation; null: not smoothed
  // Outermost points of the DEM from which the ground was cropped [m]; empty: it was not cropped.
  std::optional<std::array<std::array<double, 2>, 2>> terrain_model;  // south-west, north-east
  std::optional<Roughness> roughness;                                 // of the DEM
  std::map<std::string, Release> releases;                            // by name of the body
  ProfileTable profile;  // of a 2D case derived from maps, instead of terrain.file; empty: use the file
  std::map<std::string, SubstrateArea> substrates;  // by name, those given by maps
  std::vector<SubstrateStretch> stretches;  // of a 2D case derived from maps, in place of all substrates' extents
  Polyline2 path;                           // along which the front is measured; empty if none is given
  std::map<std::string, Polyline2> probes;  // by name: one point, or a line
  Raster bed_depth;                         // [m], at the points of the ground; empty if no raster is given
  Raster bed_in_columns;                    // [m], mean over the cell of each column of nodes; empty without polygons
  std::string crs;                          // of all maps, as WKT
  std::string heights;                      // vertical reference system of the ground; empty: not specified
  std::string crs_name;                     // "EPSG:31287", or its title; empty if none is known
};

// Profile of a case with terrain.type "profile": that of the site, otherwise the contents of terrain.file.
[[nodiscard]] inline ProfileTable profile_of(const Case& parameters, const Site& site) {
  return site.profile.empty() ? read_profile(parameters.terrain.file) : site.profile;
}

}  // namespace thawslide::config
