// Heat and water budget of the band columns of the base. For host and device.
#pragma once

#include "band/segment_step.hpp"

namespace thawslide::band {

// Since the start, or of a stage [J], [kg]. created: with new segments; left: with removed segments.
struct ColumnLedger {
  double created_heat = 0, friction_heat = 0, body_heat = 0, ground_heat = 0, vented_heat = 0, steam_heat = 0,
         left_heat = 0;
  double created_water = 0, body_water = 0, vented_water = 0, steam = 0, left_water = 0;

  // Calls visit(term) for each term, in order.
  template <class Visit>
  THAWSLIDE_HD void for_each(const Visit& visit) {
    visit(created_heat);
    visit(friction_heat);
    visit(body_heat);
    visit(ground_heat);
    visit(vented_heat);
    visit(steam_heat);
    visit(left_heat);
    visit(created_water);
    visit(body_water);
    visit(vented_water);
    visit(steam);
    visit(left_water);
  }
  THAWSLIDE_HD ColumnLedger& operator+=(const ColumnLedger& part) {
    created_heat += part.created_heat;
    friction_heat += part.friction_heat;
    body_heat += part.body_heat;
    ground_heat += part.ground_heat;
    vented_heat += part.vented_heat;
    steam_heat += part.steam_heat;
    left_heat += part.left_heat;
    created_water += part.created_water;
    body_water += part.body_water;
    vented_water += part.vented_water;
    steam += part.steam;
    left_water += part.left_water;
    return *this;
  }
};

THAWSLIDE_HD inline ColumnLedger ledger_of(const physics::ColumnBudget& budget) {
  ColumnLedger ledger;
  ledger.friction_heat = budget.friction_heat;
  ledger.body_heat = budget.body_heat;
  ledger.ground_heat = budget.ground_heat;
  ledger.vented_heat = budget.vented_heat;
  ledger.steam_heat = budget.steam_heat;
  ledger.body_water = budget.body_water;
  ledger.vented_water = budget.vented_water;
  ledger.steam = budget.steam;
  return ledger;
}
template <int Dim>
THAWSLIDE_HD ColumnLedger ledger_of_removed(const BasalSegment<Dim>& segment) {
  ColumnLedger ledger;
  ledger.left_heat = segment.area_of_column * physics::heat_of(segment.column) + segment.heat;
  ledger.left_water = segment.area_of_column * physics::water_of(segment.column);
  ledger.friction_heat = segment.heat;
  return ledger;
}

}  // namespace thawslide::band
