// Initial case for a DEM and a release, or for a section from a DEM, with suitable cell, domain and times; sweep file.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/profile_csv.hpp"
#include "config/resolution.hpp"

namespace thawslide::config {

// Default reach angle, which determines the size of the domain [degrees].
constexpr double usual_reach_angle = 8.0;

// Base of a new case: the thinnest of these bands that a rigid block without pore pressure does not warm above the
// limit, because parts of a slide without pressure boil dry; otherwise the thickest.
struct ProposedBase {
  static constexpr std::array candidates{2.0, 1.0, 0.5, 0.2, 0.1};  // m
  static constexpr double limit = 210.0;  // C: hotter bases are reported as not credible (run/step_warnings.cpp)

  double thickness = 0.2;         // of the band [m]
  double temperature = 0.0;       // maximum of the band along the path [C]
  double friction = 0.0;          // friction angle of equilibrium at the start without cohesion [degrees]
  double safety_factor = 1.0;     // sliding strength over driving traction at the start
  double missing_cohesion = 0.0;  // for equilibrium at the start [Pa]; 0: none
};

// Table [substrate.NAME], option of `new`, and assumed friction coefficient with its range, including pore pressure.
struct ProposedSubstrate {
  const char *name, *option;
  double coefficient, low, high;
  bool can_be_entrained;  // the case then contains an erodible bed as comments
};
inline constexpr std::array<ProposedSubstrate, 3> proposed_substrates{
    {{"glacier", "--glacier", 0.1, 0.05, 0.15, false},
     {"snow", "--snow", 0.15, 0.05, 0.25, false},
     {"valley_floor", "--valley-floor", 0.2, 0.1, 0.3, true}}};

// Files of polygons, as named in the case, by the names of proposed substrates.
using Outlines = std::map<std::string, std::string>;

// Taper of the edges of an excavated release that lets the slide leave the pit.
struct EdgeTaper {
  double width = 0.0;     // [m]; 0: no taper is needed, or there is no space for one
  double wanted = 0.0;    // width without limits of space [m]
  double steepest = 0.0;  // rise of the ramp against the terrain, divided by its run
  double slope = 0.0;     // fall of the terrain below the release, divided by its run
  [[nodiscard]] bool is_cramped() const { return width < wanted; }
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

// Domain that contains the release, and DEM points below a line at the reach angle from its top. dem: NaN for no data;
// thickness: vertical [m], on the same points; cell: if the user specifies it [m]; 0: that of the resolution.
[[nodiscard]] Proposal propose(const Raster& dem, const Raster& thickness, double reach_angle, double cell = 0.0,
                               Resolution resolution = Resolution::quick);

// Extent of the body on a section [m].
struct SurfaceBody {
  double begin = 0.0, end = 0.0;  // distances of the rows before the first and after the last row with a thickness
  double area = 0.0;              // [m2]
  double thickness = 0.0;         // vertical, mean weighted by area [m]
};

// Requires a profile with a surface; returns a body of zero area if the surface is nowhere above the ground.
[[nodiscard]] SurfaceBody body_on(const ProfileTable& profile);

// Domain as long as the section, in whole cells, and as high as ground and body with a margin; cell of `quick`.
[[nodiscard]] Proposal propose_section(const ProfileTable& profile, const SurfaceBody& body);

inline constexpr int margin_cells = 4;  // between the release and the sides of the domain

// Taper for an untapered vertical thickness [m]; narrower than wanted at unknown ground, or in a narrow release.
[[nodiscard]] EdgeTaper propose_taper(const Raster& dem, const Raster& thickness);

// Fall of the mean plane of the terrain below a release, divided by its run.
[[nodiscard]] double slope_below(const Raster& dem, const Raster& thickness);

// Case file with comments.
[[nodiscard]] std::string case_text(const ProposalInput& input, const Proposal& proposal);

// The same for a section; `profile_file` as named in the case.
[[nodiscard]] std::string section_text(const std::string& title, const std::string& profile_file,
                                       const Proposal& proposal, const std::optional<ProposedBase>& base = {});

// Sweep file of a case with this thickness [m] and base; quick: proposal on cells of `quick`, if the case has others.
[[nodiscard]] std::string sweep_text(double thickness, const ProposedBase& base, const std::optional<Proposal>& quick,
                                     const Outlines& outlines);

// Median of a thickness raster [m] with points of equal area: half of the area is thinner.
[[nodiscard]] double median_thickness(const Raster& thickness);

// Cell of a resolution [m] for the release of a proposal.
[[nodiscard]] double cell_of(Resolution resolution, const Proposal& proposal);

// Warning if a release is closer to unknown terrain than its own length, because avalanches spread farther; or empty.
[[nodiscard]] std::string edge_warning(const Proposal& proposal);

}  // namespace thawslide::config
