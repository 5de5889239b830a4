// Band below the rigid block as one band column (band/segment_step.hpp): a basal segment of 1 m2 that does not stretch.
#pragma once

#include "band/segment_step.hpp"
#include "sim/block/block_column.hpp"
#include "sim/setup/columns_model.hpp"

namespace thawslide::sim {

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
