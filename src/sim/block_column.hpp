// The band under the rigid block: a column of particles, one a row, that stand still on a grid of their own while the
// stages of the step conduct their heat and drain their pore pressure. Each lies in the middle between the two nodes of
// its cell's floor and those of its ceiling, so that both of a pair hold the same and nothing flows sideways.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "band/flow_depth.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::sim {

// What the contact law sees at the base nodes, interpolated as the MPM does.
struct BlockBase {
  double pore_pressure, saturation, solid_fraction, temperature;
};
// Means over the band.
struct BlockBand {
  double temperature, saturation, pore_pressure;
};
// What one step does to the base: heat flux into it [W/m2], normal pressure on it [Pa], speed of slip [m/s], slip [m],
// thickness of the band as the case has it [m], 0: no band.
struct BlockDrive {
  double heat_flux, normal_pressure, speed, slip, band_thickness, dt;
};

class BlockColumn {
 public:
  // Rows of an initially uniform body of given normal thickness [m]; fields of depth come in through `initial`.
  struct Initial {
    double thickness, cell;
    double normal_pressure;  // on the base [Pa]
    int rows_per_cell;
    std::int32_t material;                                            // number, as in Model
    std::function<double(double depth)> temperature;                  // [C]
    std::function<double(double depth, double saturation)> porosity;  // saturation: of the pores with water
  };
  BlockColumn(const band::BandModel<2, double>& model, const Initial& initial);

  // Returns the heat that rows gained per base area [J/m2].
  double step(const BlockDrive& drive);

  // Per base area; heights above the base, in the MPM's unscaled cells.
  [[nodiscard]] const mpm::Particles<2, double>& rows() const { return rows_; }
  [[nodiscard]] BlockBase base(double normal_pressure) const;
  [[nodiscard]] BlockBand band() const;

 private:
  void find_base_nodes();
  // The load on rows, in proportion to what lies above them.
  void set_normal_load(double normal_pressure);
  [[nodiscard]] double heat() const;

  band::BandModel<2, double> model_;
  mpm::SparseGrid<2, double> grid_;
  mpm::Particles<2, double> rows_;
  mpm::Nodes<2, double> nodes_;
  band::FlowDepth<2, double> flow_depth_;
  std::vector<mpm::NodeAt> base_nodes_;
  double thickness_;
};

}  // namespace thawslide::sim
