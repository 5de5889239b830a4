#include "sim/records/base_table.hpp"

#include <algorithm>

namespace thawslide::sim {

template <int Dim>
NamedNumbers base_table(const Simulation<Dim>& simulation) {
  NamedNumbers table;
  const auto* columns = simulation.band_columns();
  if (columns == nullptr) {
    return table;
  }
  const auto add = [&](const char* name, double number) { table[name].push_back(number); };
  for (const band::BasalSegment<Dim>& segment : columns->segments()) {
    const physics::BandMeans means = band::current_means(segment);
    const double* slide = segment.column.temperature + physics::ColumnCells::ground;
    for (int a = 0; a < 3; ++a) {
      table["position_m"].push_back(a < Dim ? segment.position[a] + simulation.model().origin[std::min(a, Dim - 1)]
                                            : 0.0);
    }
    add("area_m2", segment.area);
    add("thickness_m", segment.column.thickness);
    add("normal_pressure_Pa", segment.load);
    add("pore_pressure_Pa", means.pore_pressure);
    add("temperature_C", means.temperature);
    add("max_temperature_C", *std::max_element(slide, slide + physics::ColumnCells::slide));
    add("liquid_saturation", means.saturation);
    add("opening_m", band::volumes_of(columns->model(), segment).opening);
    add("slip_m", segment.slip);
    add("slip_speed_m_s", segment.speed);
  }
  return table;
}

template NamedNumbers base_table<2>(const Simulation<2>&);
template NamedNumbers base_table<3>(const Simulation<3>&);

}  // namespace thawslide::sim
