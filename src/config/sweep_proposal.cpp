#include "config/sweep_proposal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "config/rule.hpp"

namespace thawslide::config {

namespace {

constexpr double truncation = 3.0;  // standard deviations, at which sweeps truncate lognormal distributions

// Median and standard deviation of the logarithm of a lognormal distribution between two values.
std::string lognormal_text(double low, double high) {
  return fmt::format("[{:.3g}, {:.3g}]", std::sqrt(low * high), 0.5 * std::log(high / low) / truncation);
}

// Young's modulus with which a slide is compressed by 2 % below its own weight, at most that of the case [Pa].
double modulus_of_members(double thickness) {
  constexpr double unit_weight = 2.0e4, compression = 0.02, of_case = 1e8;  // N/m3, -, Pa
  return std::min(of_case, rounded_up(unit_weight * thickness / compression, 1));
}

std::string cells_text(const std::optional<Proposal>& quick) {
  if (!quick) {
    return "";
  }
  return fmt::format("\"grid.cell\" = {}  # m, of `quick`\n\"grid.min\" = {}\n\"grid.max\" = {}\n",
                     number_text(quick->cell), corner_text(quick->min), corner_text(quick->max));
}

}  // namespace

std::string sweep_text(double thickness, const ProposedBase& base, const std::optional<Proposal>& quick,
                       const Outlines& outlines) {
  constexpr double least_friction = 20.0, most_friction = 35.0;  // degrees
  constexpr double thinnest_band = 0.1, thickest_band = 1.0;     // m
  constexpr double low_ratio = 0.6, band_ratio = 0.05;
  const double high = std::clamp(std::floor(base.friction), 1.0, most_friction);
  const double low = std::min(least_friction, std::round(low_ratio * high * 10.0) / 10.0);
  const double thick = std::min(std::max(thickest_band, base.thickness), band_ratio * thickness);
  const double thin = std::min(thinnest_band, 0.5 * thick);
  return fmt::format(
      R"(# Made by `thawslide new` for `thawslide forecast`. Every number may be changed, and keys of the case added.
# "Assumed" ranges have no published source.

[sweep]
cases = ["case.toml"]
sample = "lhs:32"  # Latin hypercube of 32 members
seed = 1

# Members are less accurate than a run of case.toml, but many of them are needed.
[sweep.set]
# Pa: the slide is compressed by at most 2 % below its weight. A stiffer one needs more time steps.
"material.rock_ice.youngs_modulus" = {modulus:g}
"band.column_step" = 0.2  # s; on a slope of the Alps, travel distance and areas change by 1.3 % at most
"time.stop_at_rest" = 0.5  # m/s
"time.rest_time" = 2.0  # s
{cells}
[sweep.range]
# Degrees, before anything has melted. Assumed: {least:g} to {most:g} degrees, as for the broken body in
# docs/choosing-the-base.md. With more than {steepest:.1f} degrees and no cohesion, the rigid block would not leave. The
# lower end is at most {low_ratio:g} of the upper one.
"basal.friction_angle" = [{low:g}, {high:g}]
# Fraction of the friction work that heats the band: range of docs/choosing-the-base.md.
"basal.heat_fraction" = [0.8, 1.0]
# m. Range for forecasts of docs/choosing-the-base.md, 0.1 to 1 m, or up to the band of case.toml, but at most a
# twentieth of the slide, {thickness} m thick. Assumed: a thicker band is no longer a band.
"band.thickness" = [{thin:.3g}, {thick:.3g}]
# Degrees, of the broken material. Assumed: 35 degrees, as in docs/choosing-the-base.md, and 5 more or less.
"material.rock_ice.friction_angle" = [30.0, 40.0]
{substrates}
[sweep.lognormal]  # median, and standard deviation of the natural logarithm; truncated at 3 standard deviations
# m/s: between 1e-8 and 1e-5 m/s, the range of docs/choosing-the-base.md.
"material.rock_ice.hydraulic_conductivity" = {conductivity}

# What lies on the path decides as well. Polygons of a glacier, snow or the valley floor are options of `thawslide new`.
# If it can be entrained, add [bed] to the case.
)",
      fmt::arg("cells", cells_text(quick)), fmt::arg("substrates", substrate_ranges(outlines)),
      fmt::arg("least", least_friction), fmt::arg("most", most_friction), fmt::arg("steepest", base.friction),
      fmt::arg("low_ratio", low_ratio), fmt::arg("low", low), fmt::arg("high", high), fmt::arg("thin", thin),
      fmt::arg("thick", thick), fmt::arg("thickness", rounded_text(thickness, 3)),
      fmt::arg("modulus", modulus_of_members(thickness)), fmt::arg("conductivity", lognormal_text(1e-8, 1e-5)));
}

}  // namespace thawslide::config
