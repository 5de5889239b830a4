// A first case for a DEM and a release: cell, domain and times that fit them. What a first 2D case
// (section_proposal.hpp) has in common with it.
#pragma once

#include <string>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/resolution.hpp"
#include "config/taper_proposal.hpp"

namespace thawslide::config {

// How far a slide is given room to run where nothing else is asked for [degrees].
constexpr double usual_reach_angle = 8.0;

// What a user gives, and what a look at the files shows.
struct ProposalInput {
  std::string title;
  std::string dem_file, release_file;  // as the case is to name them; no release_file where a raster gives the release
  MapValue thickness;
  Placement placement = Placement::on_top;
  EdgeTaper taper;                         // of a release that is cut out
  double reach_angle = usual_reach_angle;  // degrees
  double largest_volume = 0.0;             // m3, confirmed; 0: the default of the parameter holds
};

struct Proposal {
  double cell = 0.0;  // [m]
  int particles_per_axis = 2;
  Point min{}, max{};             // of the domain [m]
  double end = 0.0;               // [s]
  double output_interval = 0.0;   // [s]
  double thickness = 0.0;         // [m], that the cell follows from: half of the volume is where the release is thinner
  double median_thickness = 0.0;  // [m]: half of the area is where the release is thinner; 0 in 2D
  double volume = 0.0;            // [m3], per metre of width in 2D
  double length = 0.0;            // longer side of the release's bounding box [m]; 0 in 2D
  double edge_distance = 0.0;     // from the release to the edge of the known terrain, at most its length [m]
  double particles = 0.0;         // about as many
};

// The domain holds every point of the DEM that lies below a line that falls by the reach angle from the release's
// highest point, and all of the release, which may reach a cell of the DEM beyond the points that have a thickness. The
// cell is that of the resolution. dem: NaN where there is no data; thickness: vertical [m], on points of the same
// places. `cell`: size of the grid's cells [m] if the user specifies it; 0: not specified.
[[nodiscard]] Proposal propose(const Raster& dem, const Raster& thickness, double reach_angle, double cell = 0.0,
                               Resolution resolution = Resolution::quick);

// The commented case file.
[[nodiscard]] std::string case_text(const ProposalInput& input, const Proposal& proposal);

inline constexpr int margin_cells = 4;  // between the release and the sides of the domain

// Sets the cell and the number of particles; needs volume and thicknesses. `cell` as above.
void propose_cell(Proposal& proposal, int dimension, double cell = 0.0, Resolution resolution = Resolution::quick);

// Sets the end and the interval between snapshots, for a slide that may go so far [m].
void propose_times(Proposal& proposal, double farthest);

// The table [time], without an empty line after it.
[[nodiscard]] std::string time_text(const Proposal& proposal);

// Of a raster of thickness [m] on points of one area each: half of the area is where it is thinner.
[[nodiscard]] double median_thickness(const Raster& thickness);

// The release of a 3D case, which has maps.
[[nodiscard]] BodyOnCells release_on_cells(const Proposal& proposal);

// A warning for a release that is nearer to the edge of the DEM, or to points without data, than its own length: an
// avalanche spreads and travels by more than that. Empty where it is not.
[[nodiscard]] std::string edge_warning(const Proposal& proposal);

// How many particles the cell puts across the thickness, for the comment at grid.cell.
[[nodiscard]] std::string cell_comment(const Proposal& proposal);

// The last keys of the body: particles and initial state.
[[nodiscard]] std::string body_state_text(const Proposal& proposal);

// The tables of material, base and band.
[[nodiscard]] std::string physics_text();

}  // namespace thawslide::config
