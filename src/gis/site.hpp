// Map data of a case: ground, releases, path and probes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

struct SiteAndWarnings {
  config::Site site;
  std::vector<std::string> warnings;  // from the reading: a sentence each, without a full stop
};

// Reads and checks all of them. Throws UserError at the location of the key that named a file.
[[nodiscard]] SiteAndWarnings load_site(const config::Case& parameters);

// Substrates given by maps, by name. Throws UserError for one outside the domain, and for two that overlap by more than
// a thousandth of the smaller area, because adjacent outlines share slivers. Warnings report codes that belong to no
// substrate, and parts of the domain not covered by a raster.
[[nodiscard]] std::map<std::string, config::SubstrateArea> load_substrates(const config::Case& parameters,
                                                                           const Dem& ground,
                                                                           std::vector<std::string>& warnings);

// Values at the points of the ground; empty if no raster is specified. Throws UserError for a raster with no data in
// the domain, or with a depth below 0 or above grid.cell.
[[nodiscard]] Raster load_bed_depth(const config::Case& parameters, const Dem& ground,
                                    std::vector<std::string>& warnings);

// Means over the cells of the columns of nodes, by the exact area of the polygons in each cell and in the domain; empty
// if no polygons are specified. Throws UserError for polygons outside the domain, for a depth that is missing, below 0
// or above grid.cell, and for polygons of different depths that overlap.
[[nodiscard]] Raster load_bed_in_columns(const config::Case& parameters, const Dem& ground,
                                         std::vector<std::string>& warnings);

}  // namespace thawslide::gis
