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

// Substrates given by maps, by name. Throws UserError for one outside the domain and for two that overlap. Warns about
// codes without a substrate, and parts of the domain without a code.
[[nodiscard]] std::map<std::string, config::SubstrateArea> load_substrates(const config::Case& parameters,
                                                                           const Dem& ground,
                                                                           std::vector<std::string>& warnings);

// At the points of the ground; empty without a raster. Throws UserError for no data or a depth not from 0 to grid.cell.
[[nodiscard]] Raster load_bed_depth(const config::Case& parameters, const Dem& ground,
                                    std::vector<std::string>& warnings);

// Means over the cells of columns of nodes; empty without polygons. Throws UserError for polygons outside the domain or
// with different depths that overlap, and for a depth not from 0 to grid.cell.
[[nodiscard]] Raster load_bed_in_columns(const config::Case& parameters, const Dem& ground,
                                         std::vector<std::string>& warnings);

}  // namespace thawslide::gis
