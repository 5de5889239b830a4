// Initial case for a DEM and a release, with suitable cell, domain and times; also functions shared with 2D cases
// (section_proposal.hpp).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/resolution.hpp"
#include "config/substrate_proposal.hpp"
#include "config/taper_proposal.hpp"

namespace thawslide::config {

// Default reach angle, which determines the size of the domain [degrees].
constexpr double usual_reach_angle = 8.0;

// Base of a new case, chosen by the rigid block: the thinnest of these bands that friction without pore pressure does
// not warm above the limit, as parts of a slide without pressure boil dry. The thickest one if none is.
struct ProposedBase {
  static constexpr std::array candidates{2.0, 1.0, 0.5, 0.2, 0.1};  // m
  static constexpr double limit = 210.0;  // C: hotter bases are reported as not credible (run/step_warnings.cpp)

  double thickness = 0.2;         // of the band [m]
  double temperature = 0.0;       // maximum of the band along the path [C]
  double friction = 0.0;          // friction angle of equilibrium at the start without cohesion [degrees]
  double safety_factor = 1.0;     // sliding strength over driving traction at the start
  double missing_cohesion = 0.0;  // for equilibrium at the start [Pa]; 0: none
};

// User input and facts from the files.
struct ProposalInput {
  std::string title;
  std::string dem_file, release_file;  // as named in the case; no release_file if a raster specifies the release
  MapValue thickness;
  Placement placement = Placement::on_top;
  EdgeTaper taper;                         // of an excavated release
  double reach_angle = usual_reach_angle;  // degrees
  double largest_volume = 0.0;             // m3, confirmed; 0: default of the parameter
  double filter = 0.0;                     // m: standard deviation of the filter of the DEM
  std::optional<ProposedBase> base;        // none if the block has no path
  Outlines outlines;
};

struct Proposal {
  double cell = 0.0;  // [m]
  int particles_per_axis = 2;
  Point min{}, max{};             // of the domain [m]
  double end = 0.0;               // [s]
  double output_interval = 0.0;   // [s]
  double thickness = 0.0;         // [m], determines the cell: half of the volume lies where the release is thinner
  double median_thickness = 0.0;  // [m]: half of the area lies where the release is thinner; 0 in 2D
  double volume = 0.0;            // [m3], per metre of width in 2D
  double length = 0.0;            // longer side of the release's bounding box [m]; 0 in 2D
  double edge_distance = 0.0;     // from the release to the edge of the known terrain, at most the release's length [m]
  double particles = 0.0;         // approximate number
};

// Proposes a domain that contains all DEM points below a line at the reach angle from the release's highest point. It
// also contains the whole release, which may extend one DEM cell beyond the points with a thickness. The cell is that
// of the resolution. dem: NaN for no data; thickness: vertical [m], on the same points. `cell`: size of the grid's
// cells [m] if the user specifies it; 0: not specified.
[[nodiscard]] Proposal propose(const Raster& dem, const Raster& thickness, double reach_angle, double cell = 0.0,
                               Resolution resolution = Resolution::quick);

// Case file with comments.
[[nodiscard]] std::string case_text(const ProposalInput& input, const Proposal& proposal);

inline constexpr int margin_cells = 4;  // between the release and the sides of the domain

// Sets the cell and the number of particles; needs volume and thicknesses. `cell` as above.
void propose_cell(Proposal& proposal, int dimension, double cell = 0.0, Resolution resolution = Resolution::quick);

// Sets the end and the interval between snapshots; farthest: maximum travel distance [m].
void propose_times(Proposal& proposal, double farthest);

// Corner of a domain in 3D.
[[nodiscard]] std::string corner_text(const Point& corner);

// Table [time], without a trailing empty line.
[[nodiscard]] std::string time_text(const Proposal& proposal);

// Median of a thickness raster [m] with points of equal area: half of the area is thinner.
[[nodiscard]] double median_thickness(const Raster& thickness);

// Cell of `quick` [m], whatever cell was chosen. It determines the filter of the DEM, so that slides on different cells
// move on the same ground.
[[nodiscard]] double quick_cell(const Proposal& proposal);

// Release of a 3D case, which has maps.
[[nodiscard]] BodyOnCells release_on_cells(const Proposal& proposal);

// Warning if a release is closer to the DEM edge or to no-data points than its own length, because an avalanche spreads
// and travels farther than that. Empty otherwise.
[[nodiscard]] std::string edge_warning(const Proposal& proposal);

// Number of particles across the thickness, for the comment at grid.cell.
[[nodiscard]] std::string cell_comment(const Proposal& proposal);

// Last keys of the body: particles and initial state.
[[nodiscard]] std::string body_state_text(const Proposal& proposal);

// Tables of transfer, material, base and band.
[[nodiscard]] std::string physics_text(const std::optional<ProposedBase>& base = {});

}  // namespace thawslide::config
