// The column of particle rows under the rigid block: heat and pore pressure across the band.
#pragma once

#include <functional>
#include <vector>

#include "band/model.hpp"

namespace thawslide::sim {

// One particle row; heights above the base, in the MPM's unscaled cells.
struct BlockRow {
  double height;  // of its middle [m]
  double depth;   // of ice pressure's overburden along the normal [m]
  bool in_band;   // in the first cell
  double porosity, initial_porosity, initial_saturation;
  double temperature, previous_temperature, heat_content, saturation;
  double liquid_pressure = 0, ice_pressure = 0, pore_pressure = 0;
  double secant_capacity = 0, conduction_in_cell = 0, seepage_in_cell = 0;
};

// What the contact law sees at the base node, interpolated as the MPM does.
struct BlockBase {
  double pore_pressure, saturation, solid_fraction, temperature;
};

class BlockColumn {
 public:
  // Rows of an initially uniform body of given normal thickness [m]; fields of depth come in through `initial`.
  struct Initial {
    double thickness, cell;
    int rows_per_cell;
    std::function<double(double depth)> temperature;                  // [C]
    std::function<double(double depth, double saturation)> porosity;  // saturation: of the pores with water
    double hydraulic_conductivity;
  };
  BlockColumn(const band::BandModel<2, double>& model, const Initial& initial);

  [[nodiscard]] const std::vector<BlockRow>& rows() const { return rows_; }
  [[nodiscard]] BlockBase base() const;
  // Heat per base area that rows hold, in the volume scaled by xi [J/m2].
  [[nodiscard]] double heat(double scaling) const;

  // One step of Eqs. 18, 19 with a heat flux into the base node [W/m2]; xi = scaling.
  void conduct_heat(double flux, double scaling, double dt);
  // One step of Eqs. 4, 8, 21-23.
  void drain_pore_pressure(double scaling, double dt);

 private:
  // Nodes below and above a row, and the weight of the lower one.
  struct Place {
    std::size_t node;
    double weight;
  };
  [[nodiscard]] Place place(const BlockRow& row) const;
  [[nodiscard]] std::vector<double> nodal_rates(const std::vector<double>& power,
                                                const std::vector<double>& capacity) const;
  [[nodiscard]] std::vector<double> averaged(double BlockRow::*member) const;
  // Pressure that seepage between nodes brings to each node in a step; that within cells goes to the rows.
  [[nodiscard]] std::vector<double> seepage_between_nodes(double scaling, double dt);
  // The liquid's pressure goes on from where it was, or starts with Clapeyron's; `from`: temperature it is heated from
  // [C].
  void set_pressure(BlockRow& row, bool was_melted, double from, double seepage_change) const;

  const band::BandModel<2, double>* model_;
  double cell_, row_height_, hydraulic_conductivity_;
  std::size_t nodes_;
  std::vector<BlockRow> rows_;
};

}  // namespace thawslide::sim
