#include "sim/block_column.hpp"

#include <algorithm>
#include <cmath>

#include "physics/clapeyron.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::sim {

BlockColumn::BlockColumn(const band::BandModel<2, double>& model, const Initial& initial)
    : model_(&model),
      cell_(initial.cell),
      row_height_(initial.cell / initial.rows_per_cell),
      hydraulic_conductivity_(initial.hydraulic_conductivity) {
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(initial.thickness / row_height_)));
  nodes_ = (count - 1) / static_cast<std::size_t>(initial.rows_per_cell) + 2;
  model.with_heat_content([&](const auto& content) {
    for (std::size_t k = 0; k < count; ++k) {
      BlockRow row{};
      row.height = (static_cast<double>(k) + 0.5) * row_height_;
      row.in_band = row.height < cell_;
      row.depth = row.in_band ? initial.thickness : std::max(0.0, initial.thickness - row.height);
      const double depth = std::max(0.0, initial.thickness - row.height);
      row.temperature = row.previous_temperature = initial.temperature(depth);
      row.saturation = row.initial_saturation = content.curve.saturation(row.temperature);
      row.porosity = row.initial_porosity = initial.porosity(depth, row.saturation);
      row.heat_content = content.content(row.temperature, row.initial_porosity);
      rows_.push_back(row);
    }
  });
  if (model.pressure) {
    for (BlockRow& row : rows_) {
      set_pressure(row, false, row.temperature, 0.0);
    }
  }
}

BlockColumn::Place BlockColumn::place(const BlockRow& row) const {
  const double in_cells = row.height / cell_;
  const double node = std::floor(in_cells);
  return {static_cast<std::size_t>(node), 1.0 - (in_cells - node)};
}

BlockBase BlockColumn::base() const {
  BlockBase base{};
  double weights = 0.0;
  for (const BlockRow& row : rows_) {
    const Place at = place(row);
    if (at.node == 0) {
      weights += at.weight;
      base.pore_pressure += at.weight * row.pore_pressure;
      base.temperature += at.weight * row.temperature;
      base.saturation += at.weight * row.saturation;
      base.solid_fraction += at.weight * physics::effective_solid_fraction(
                                             model_->phases, model_->lubrication ? row.porosity : row.initial_porosity,
                                             model_->lubrication ? row.saturation : row.initial_saturation);
    }
  }
  return {base.pore_pressure / weights, base.saturation / weights, base.solid_fraction / weights,
          base.temperature / weights};
}

double BlockColumn::heat(double scaling) const {
  double sum = 0.0;
  for (const BlockRow& row : rows_) {
    sum += row.heat_content * row_height_ / scaling;
  }
  return sum;
}

std::vector<double> BlockColumn::averaged(double BlockRow::*member) const {
  std::vector<double> sum(nodes_, 0.0);
  std::vector<double> weights(nodes_, 0.0);
  for (const BlockRow& row : rows_) {
    const Place at = place(row);
    sum[at.node] += at.weight * row.*member;
    weights[at.node] += at.weight;
    sum[at.node + 1] += (1.0 - at.weight) * row.*member;
    weights[at.node + 1] += 1.0 - at.weight;
  }
  return nodal_rates(sum, weights);
}

std::vector<double> BlockColumn::nodal_rates(const std::vector<double>& power,
                                             const std::vector<double>& capacity) const {
  std::vector<double> rates(nodes_, 0.0);
  for (std::size_t i = 0; i < nodes_; ++i) {
    rates[i] = capacity[i] > 0.0 ? power[i] / capacity[i] : 0.0;
  }
  return rates;
}

void BlockColumn::conduct_heat(double flux, double scaling, double dt) {
  model_->with_heat_content([&](const auto& content) {
    const std::vector<double> temperature = averaged(&BlockRow::temperature);
    const std::vector<double> pressure = averaged(&BlockRow::pore_pressure);
    std::vector<double> power(nodes_, 0.0);
    std::vector<double> tangent(nodes_, 0.0);
    std::vector<double> subgrid(nodes_, 0.0);
    power[0] = flux;
    for (BlockRow& row : rows_) {
      const Place at = place(row);
      const double gradient = (temperature[at.node + 1] - temperature[at.node]) / cell_;
      const double pressure_gradient = (pressure[at.node + 1] - pressure[at.node]) / cell_;
      double flow = 0.0;
      row.secant_capacity = content.apparent_capacity(row.temperature, row.initial_porosity);
      row.conduction_in_cell = 0.0;
      if (model_->conduction) {
        const double conductivity = physics::conductivity(model_->phases, row.porosity, row.saturation);
        flow = -row_height_ * scaling * conductivity * gradient;
        const double seen = at.weight * temperature[at.node] + (1.0 - at.weight) * temperature[at.node + 1];
        if (model_->secant_capacity) {
          row.conduction_in_cell =
              (seen - row.temperature) *
              physics::share_of_subgrid_diffusion(conductivity / row.secant_capacity, scaling / cell_, 2, dt);
        }
      }
      double advection = 0.0;
      if (model_->advection && model_->seepage && model_->thermal_pressurization &&
          row.temperature >= model_->reference_temperature) {
        advection = row_height_ * model_->phases.water_density * model_->phases.water_heat_capacity * scaling *
                    hydraulic_conductivity_ / model_->phases.water_unit_weight * pressure_gradient * gradient;
      }
      const double capacity = row_height_ / scaling * row.secant_capacity;
      power[at.node] += -flow / cell_ + at.weight * advection;
      power[at.node + 1] += flow / cell_ + (1.0 - at.weight) * advection;
      subgrid[at.node] += at.weight * capacity * row.conduction_in_cell;
      subgrid[at.node + 1] += (1.0 - at.weight) * capacity * row.conduction_in_cell;
      tangent[at.node] += at.weight * capacity;
      tangent[at.node + 1] += (1.0 - at.weight) * capacity;
    }
    const auto less = [&](const std::vector<double>& heat) {
      std::vector<double> left(nodes_);
      for (std::size_t i = 0; i < nodes_; ++i) {
        left[i] = power[i] - heat[i] / dt;
      }
      return left;
    };
    const std::vector<double> predicted = nodal_rates(less(subgrid), tangent);
    std::vector<double> secant(nodes_, 0.0);
    subgrid.assign(nodes_, 0.0);
    for (BlockRow& row : rows_) {
      const Place at = place(row);
      const double change =
          row.conduction_in_cell + dt * (at.weight * predicted[at.node] + (1.0 - at.weight) * predicted[at.node + 1]);
      row.secant_capacity = model_->secant_capacity
                                ? content.secant_capacity(row.temperature, change, row.initial_porosity)
                                : content.apparent_capacity(row.temperature, row.initial_porosity);
      const double capacity = row_height_ / scaling * row.secant_capacity;
      secant[at.node] += at.weight * capacity;
      secant[at.node + 1] += (1.0 - at.weight) * capacity;
      subgrid[at.node] += at.weight * capacity * row.conduction_in_cell;
      subgrid[at.node + 1] += (1.0 - at.weight) * capacity * row.conduction_in_cell;
    }
    const std::vector<double> rates = nodal_rates(less(subgrid), secant);
    for (BlockRow& row : rows_) {
      const Place at = place(row);
      row.previous_temperature = row.temperature;
      const double change =
          row.conduction_in_cell + dt * (at.weight * rates[at.node] + (1.0 - at.weight) * rates[at.node + 1]);
      if (model_->secant_capacity) {
        row.heat_content += row.secant_capacity * change;
        row.temperature = content.temperature(row.heat_content, row.initial_porosity, row.temperature);
      } else {
        row.temperature += change;
        row.heat_content = content.content(row.temperature, row.initial_porosity);
      }
      row.saturation = content.curve.saturation(row.temperature);
      row.porosity =
          physics::updated_porosity(model_->phases, row.porosity, 0.0, row.temperature - row.previous_temperature);
    }
  });
}

std::vector<double> BlockColumn::seepage_between_nodes(double scaling, double dt) {
  const double pore_scaling = physics::pore_space_scaling(scaling, model_->seepage_as_printed);
  const std::vector<double> pressure = averaged(&BlockRow::pore_pressure);
  std::vector<double> inflow(nodes_, 0.0);
  std::vector<double> pores(nodes_, 0.0);
  for (BlockRow& row : rows_) {
    const Place at = place(row);
    double flow = 0.0;
    row.seepage_in_cell = 0.0;
    if (row.previous_temperature >= model_->reference_temperature) {
      const double gradient = (pressure[at.node + 1] - pressure[at.node]) / cell_;
      flow = -row_height_ * scaling * hydraulic_conductivity_ / model_->phases.water_unit_weight *
             model_->phases.water_bulk_modulus * gradient;
      const double seen = at.weight * pressure[at.node] + (1.0 - at.weight) * pressure[at.node + 1];
      const double diffusivity =
          scaling * pore_scaling *
          physics::hydraulic_diffusivity(model_->phases, row.porosity, 1.0, hydraulic_conductivity_);
      row.seepage_in_cell =
          (seen - row.pore_pressure) * physics::share_of_subgrid_diffusion(diffusivity, 1.0 / cell_, 2, dt);
    }
    const double pore_space = row_height_ / pore_scaling * row.porosity;
    inflow[at.node] += -dt * flow / cell_ - at.weight * pore_space * row.seepage_in_cell;
    inflow[at.node + 1] += dt * flow / cell_ - (1.0 - at.weight) * pore_space * row.seepage_in_cell;
    pores[at.node] += at.weight * pore_space;
    pores[at.node + 1] += (1.0 - at.weight) * pore_space;
  }
  return nodal_rates(inflow, pores);
}

void BlockColumn::set_pressure(BlockRow& row, bool was_melted, double from, double seepage_change) const {
  row.ice_pressure = physics::ice_pressure(model_->phases, model_->gravity, row.depth);
  if (row.temperature < model_->reference_temperature) {
    row.liquid_pressure = physics::liquid_pressure_clapeyron(model_->phases, row.ice_pressure, row.temperature,
                                                             model_->reference_temperature, model_->clapeyron_sign);
  } else {
    const double start = row.ice_pressure * model_->phases.water_density / model_->phases.ice_density;
    if (!model_->thermal_pressurization) {
      row.liquid_pressure = start;
    } else {
      row.liquid_pressure = (was_melted ? row.liquid_pressure : start) +
                            physics::undrained_pressure_coefficient(model_->phases, row.porosity, row.saturation) *
                                (row.temperature - from) +
                            seepage_change;
    }
  }
  row.pore_pressure = physics::pore_pressure(row.saturation, row.liquid_pressure, row.ice_pressure);
}

void BlockColumn::drain_pore_pressure(double scaling, double dt) {
  if (!model_->pressure) {
    return;
  }
  const bool seepage = model_->seepage && model_->thermal_pressurization && hydraulic_conductivity_ > 0.0;
  const std::vector<double> changes = seepage ? seepage_between_nodes(scaling, dt) : std::vector<double>(nodes_, 0.0);
  const double top = rows_.back().height + 0.5 * row_height_;
  for (BlockRow& row : rows_) {
    const Place at = place(row);
    const bool was_melted = row.previous_temperature >= model_->reference_temperature;
    const double change =
        was_melted ? row.seepage_in_cell + at.weight * changes[at.node] + (1.0 - at.weight) * changes[at.node + 1]
                   : 0.0;
    set_pressure(row, was_melted, was_melted ? row.previous_temperature : model_->reference_temperature, change);
    if (seepage && row.temperature >= model_->reference_temperature && top - row.height < 0.5 * cell_) {
      row.liquid_pressure = row.pore_pressure = 0.0;
    }
  }
}

}  // namespace thawslide::sim
