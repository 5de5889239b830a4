// What map files tell of a case: the ground, and what each body is there. Read by the gis room, used by the simulation.
// And the profile of a 2D case, from its file or from memory.
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

using Polyline2 = std::vector<std::array<double, 2>>;  // x, y [m] of its corners

struct Release {
  Raster thickness;   // vertical [m] at the points of the ground's raster, cropped to the release; 0 outside
  double area = 0.0;  // horizontal, of the outlines [m2]
  std::vector<Polyline2> outlines;       // closed rings, for pictures; empty where a raster gives the release
  std::map<std::string, Raster> fields;  // by key of the body: "temperature", "porosity", ... where a map gives it
  // Of a body that touches another one, else empty. A place belongs to the body within whose outline it lies, beyond
  // all outlines to the one with the largest claim.
  Raster standing;  // vertical thickness [m] in the body's own part, without an edge towards the others
  Raster claim;  // share of each point's cell that the outline covers; beyond all outlines, that its taper spreads to
};

// Where a substrate lies, as maps tell it.
struct SubstrateArea {
  std::vector<Polyline2> rings;         // closed: outlines and their holes; empty where a raster tells
  std::shared_ptr<const Raster> codes;  // null where polygons tell
  double code = 0.0;                    // of the raster
  double area = 0.0;                    // horizontal, within the domain [m2]
};

// A part of a section in which a substrate lies, from one x to another [m].
struct SubstrateStretch {
  std::string name;
  double from, to;
};

// Noise and short bumps of a DEM, and the filter against them.
struct Roughness {
  double noise = 0.0;              // rms of white noise on points `spacing` apart that is as rough [m]
  double spacing = 0.0;            // [m]
  double cell = 0.0;               // of the grid [m]
  double bump_length = 0.0;        // that shorter bumps are counted up to [m]
  double bump_slope = 0.0;         // rms slope of these bumps without a filter
  double width = 0.0;              // standard deviation of the filter [m]; 0: none
  double slope_left = 0.0;         // rms slope of noise or bumps at the scale of the cell, after the filter
  double apparent_friction = 0.0;  // that it adds, as a share of the friction
  double narrow_valley = 0.0;      // narrower ones lose a part of their wedge effect by the filter [m]
};

// With their names in files of JSON.
using NamedFigures = std::vector<std::pair<std::string, double>>;
[[nodiscard]] NamedFigures named(const Roughness& ground);

struct Site {
  std::shared_ptr<const Raster> ground;  // what bodies slide on, less what is cut out of it; null: no raster
  // Outermost points of the DEM that the ground was cropped from [m]; empty: it was not cropped.
  std::optional<std::array<std::array<double, 2>, 2>> terrain_model;  // south-west, north-east
  std::optional<Roughness> roughness;                                 // of the DEM
  std::map<std::string, Release> releases;                            // by name of the body
  ProfileTable profile;  // of a 2D case cut out of maps, instead of terrain.file; empty: there is the file
  std::map<std::string, SubstrateArea> substrates;  // by name, those that maps give
  std::vector<SubstrateStretch> stretches;          // of a 2D case cut out of maps, in place of all substrates' own
  Polyline2 path;                                   // along which the front is measured; empty: none given
  std::map<std::string, Polyline2> probes;          // by name: one point, or a line
  Raster bed_depth;                                 // [m], at the points of the ground; empty: no raster gives it
  std::string crs;                                  // of all of them, as WKT
  std::string crs_name;                             // "EPSG:31287", or its title; empty: none is known
};

// The profile of a case with terrain.type "profile": the site's, or else what terrain.file holds.
[[nodiscard]] ProfileTable profile_of(const Case& parameters, const Site& site);

}  // namespace thawslide::config
