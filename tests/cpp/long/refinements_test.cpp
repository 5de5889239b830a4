// Sections of the verification on finer cells, for more slopes, directions and sizes.
#include <gtest/gtest.h>

#include "../support/record.hpp"
#include "../verification/bar_collapse.hpp"
#include "../verification/channel_on_dem.hpp"
#include "../verification/cylinder_column.hpp"
#include "../verification/incline_energy.hpp"
#include "../verification/manufactured_vibration.hpp"
#include "../verification/plane_on_dem.hpp"
#ifdef THAWSLIDE_WITH_GIS
#include "../verification/rough_dem.hpp"
#endif

namespace thawslide::verification {
namespace {

// Convergence of the collapse of a column of aluminium bars as cells become smaller.
TEST(FineBarCollapse, EndsNearTheMeasuredSurface) {
  using namespace bar_collapse;
  Record record = make_record("Collapse of a column of aluminium bars, finer cells");
  const std::vector<double> places = measured("surface").x;
  for (const std::string transfer : {"flip", "apic"}) {
    std::vector<double> before = surface_of(Collapse(0.02, transfer), places);
    std::vector<double> changes;
    for (const double cell : {0.01, 0.005, 0.0025}) {
      const std::vector<double> surface = expect_measured(record, cell, transfer, cell < 0.003 && transfer == "apic");
      changes.push_back(root_mean_square(differences(surface, before)));
      before = surface;
    }
    record.expect_order_at_least("cell [mm]", {20.0, 10.0, 5.0}, "rms change with half the cell [mm], " + transfer,
                                 changes, 1.0, 0.5);
  }
}

// V channels of three openings and two widths, with the thalweg on and between grid lines and oblique to them.
TEST(VChannelsOnDem, FrictionIsThatOfAWedge) {
  using namespace channel_on_dem;
  Record record = make_record("V channels on a DEM: openings, widths and directions");
  for (const double cells : {8.0, 4.0}) {
    for (const double opening : {120.0, 90.0, 60.0}) {
      for (const Course& course : {Course{0.0, 0.0}, Course{0.0, 2.5}, Course{22.5, 0.0}, Course{45.0, 0.0}}) {
        const double between_columns = opening == 60.0 ? 0.08 : 0.03;
        expect_wedge(record, opening, cells, course, course.aside > 0.0 ? between_columns : 0.015);
      }
    }
  }
}

// Cylindrical granular columns of three heights collapse.
TEST(CylindricalColumns, RunoutAgreesWithExperiments) {
  using namespace cylinder_column;
  Record record = make_record("Collapse of cylindrical granular columns");
  for (const double aspect : {0.5, 1.0, 2.0}) {
    expect_runout(record, aspect);
  }
}

// Collapse of a cylindrical granular column on up to 64 cells across its radius.
TEST(FineCylinderSection, RunoutAgreesWithExperiments) {
  using namespace cylinder_column;
  Record record = make_section_record("Collapse of a cylindrical granular column on fine cells");
  expect_approach(record, {16, 32, 64}, {0.40, 0.15, 0.08});
  record.expect_near("section less column in space, 16 cells",
                     runout_of_section(16, "apic") - collapse(1.0, radius / 16, "apic"), 0.0, 0.05);
}

// The complete 25 s on the incline: the mechanical energy budget closes.
TEST(WholeIncline, MechanicalResidualIsOfFirstOrderInTheStep) {
  Record record(
      "Mechanical energy budget on the incline, 25 s",
      "Cases D, D-L, D-L-P and P-L of Sec. 3.3: mechanical_residual_J over the work of gravity and the size of "
      "the friction work; asserted below 1 % with each step.",
      "no energy remains except the error of time integration", "energy balance");
  expect_closed_budget(record, 25.0, 0.15);
}

#ifdef THAWSLIDE_WITH_GIS
// Noise of many amplitudes on the points of a DEM, filtered.
TEST(RoughDems, FilteredAddNoFriction) {
  using namespace rough_dem;
  Record record = make_record("Noise on the points of a DEM, filtered: sizes and distances of points");
  for (const double spacing : {1.0, 0.5}) {
    for (const double noise : {0.05, 0.1, 0.2, 0.5}) {
      for (const unsigned seed : {3U, 4U, 5U}) {
        expect_no_friction_on_plane(record, noise, spacing, noise < 0.5 ? 0.03 : 0.05, seed);
      }
    }
  }
}
#endif

// The manufactured vibration with large displacements, with one more refinement than the short tests.
TEST(FineVibration, ManufacturedWithLargeDisplacements) {
  Record record("Momentum, manufactured, large displacements, fine",
                problem + "A = 0.02: stretches from 0.87 to 1.13, and particles cross cells.", solution, source);
  const std::vector<int> cells{16, 32, 64};
  const std::vector<double> sizes{1.0 / 16, 1.0 / 32, 1.0 / 64};
  for (const Choice& choice : {ugimp_flip, ugimp_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 0.02, cells), 1.0, 0.25);
  }
  for (const Choice& choice : {quadratic_flip, quadratic_apic}) {
    record.expect_order_at_least("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                                 errors_of(choice, 0.02, cells), 1.0, 0.1);
  }
}

// By the symmetries of the square, the azimuths represent 0, 7.5, 15, ... 45 degrees.
TEST(PlanesOnDem, BlocksSlideOrStickInAllDirections) {
  using namespace plane_on_dem;
  Record record = make_record("Block on planes of a DEM, four slopes and eight directions");
  for (const double slope : {0.0, 15.0, 30.0, 45.0}) {
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (int k = 0; k < 8; ++k) {
      const Plane plane{slope, 52.5 * k};
      if (slope == 0.0 || k == 3) {
        expect_rest(record, plane, slope + 5.0);
      }
      if (slope > 0.0) {
        const double acceleration = expect_slide(record, plane, 0.5 * slope).acceleration;
        least = std::min(least, acceleration);
        greatest = std::max(greatest, acceleration);
      }
    }
    if (slope > 0.0) {
      record.expect_near(fmt::format("spread of the acceleration over all directions, {} degrees", slope),
                         (greatest - least) / greatest, 0.0, 1e-3);
    }
  }
}

// Cohesion depends on the contact area, which is closer to that of the base on smaller cells.
const std::vector<std::string> half_cells{"grid.cell=2.5", "time.step=0.0005", "material.debris.viscosity_time=0.01"};

TEST(PlanesOnDem, CohesionBrakesInAllDirections) {
  using namespace plane_on_dem;
  Record record = make_record("Block with cohesion on planes of a DEM");
  for (const double azimuth : {0.0, 52.5, 105.0, 157.5}) {
    expect_slide(record, {30.0, azimuth}, 10.0, 4e4, half_cells);
  }
}

}  // namespace
}  // namespace thawslide::verification
