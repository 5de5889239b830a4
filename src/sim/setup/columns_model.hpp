// Builds the model of band columns from the case.
#pragma once

#include "band/segment_step.hpp"
#include "config/case.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// Material of the columns at the body's base: temperature [C], porosity, hydraulic conductivity [m/s], and maximum flow
// depth [m].
struct ColumnMaterial {
  double temperature, porosity, hydraulic_conductivity, depth;
};

template <int Dim>
band::ColumnsModel make_columns_model(const config::Case& parameters, const Model<Dim>& model,
                                      const ColumnMaterial& material);

}  // namespace thawslide::sim
