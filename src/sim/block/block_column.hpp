// Band below the rigid block: a band column, or a column of particles, one per row, at rest on a separate grid. The
// stages of the MPM step conduct their heat and drain their pore pressure. Each particle lies midway between the two
// lower and the two upper nodes of its cell. Both nodes of a pair therefore hold the same values, and no lateral flux
// occurs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "band/flow_depth.hpp"
#include "band/segment_step.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::sim {

// Basal state for the contact law, interpolated to the base nodes as in the MPM.
struct BlockBase {
  double pore_pressure, saturation, solid_fraction, temperature;
};
// Means over the band.
struct BlockBand {
  double temperature, saturation, pore_pressure;
};
// Input of one step at the base: heat flux into it [W/m2], normal pressure on it [Pa], slip speed [m/s], slip [m], band
// thickness specified by the case [m] (0: no band).
struct BlockDrive {
  double heat_flux, normal_pressure, speed, slip, band_thickness, dt;
};

class BlockColumn {
 public:
  // Initial state of a body of uniform normal thickness [m]; fields over depth are specified as functions in `Initial`.
  struct Initial {
    double thickness, cell;
    double normal_pressure;  // on the base [Pa]
    int rows_per_cell;
    std::int32_t material;                                            // number, as in Model
    std::function<double(double depth)> temperature;                  // [C]
    std::function<double(double depth, double saturation)> porosity;  // saturation: water fraction of the pores
  };
  BlockColumn(const band::BandModel<2>& model, const Initial& initial);

  // Returns the heat gained by the rows per base area [J/m2].
  double step(const BlockDrive& drive);

  // Quantities per base area; heights are above the base, in the unscaled cells of the MPM.
  [[nodiscard]] const mpm::Particles<2>& rows() const { return rows_; }
  [[nodiscard]] BlockBase base(double normal_pressure) const;
  [[nodiscard]] BlockBand band() const;

 private:
  void find_base_nodes();
  // Sets the load on each row in proportion to the mass above it.
  void set_normal_load(double normal_pressure);
  [[nodiscard]] double heat() const;

  band::BandModel<2> model_;
  mpm::SparseGrid<2> grid_;
  mpm::Particles<2> rows_;
  mpm::Nodes<2> nodes_;
  band::FlowDepth<2> flow_depth_;
  std::vector<mpm::NodeAt> base_nodes_;
  double thickness_;
};

// One band column (band/segment_step.hpp): a basal segment of 1 m2 that does not stretch.
class BlockBandColumn {
 public:
  // load: initial normal pressure [Pa]; column_step: maximum time step of the column [s].
  BlockBandColumn(const band::ColumnsModel& model, double thickness, double load, double column_step);

  // Returns the heat gained by the column [J/m2], including heat that is pending until its next step.
  double step(const BlockDrive& drive);
  // Basal state for the basal law under a normal pressure [Pa].
  [[nodiscard]] BlockBase base(double normal_pressure) const;
  [[nodiscard]] BlockBand band() const;
  [[nodiscard]] const band::BasalSegment<2>& segment() const { return segment_; }

 private:
  band::ColumnsModel model_;
  band::BasalSegment<2> segment_;
  double column_step_, waiting_ = 0.0;
};

}  // namespace thawslide::sim
