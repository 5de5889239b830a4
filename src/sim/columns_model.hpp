// From the case to the model of band columns.
#pragma once

#include "band/basal_segments.hpp"
#include "config/case.hpp"
#include "sim/model.hpp"

namespace thawslide::sim {

// What columns are made of, and where: temperature of the body's base [C], its porosity and hydraulic conductivity
// [m/s], its largest thickness [m].
struct ColumnMaterial {
  double temperature, porosity, hydraulic_conductivity, depth;
};

template <int Dim, class Real>
band::ColumnsModel<Real> make_columns_model(const config::Case& parameters, const Model<Dim, Real>& model,
                                            const ColumnMaterial& material);

}  // namespace thawslide::sim
