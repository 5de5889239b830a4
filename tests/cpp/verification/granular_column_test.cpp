// Collapse of granular columns, cylinders and bars, compared with laws fitted to experiments and with measurements.
// Also the dry dam break, for which thin flow has an exact solution.
#include "bar_collapse.hpp"
#include "cylinder_column.hpp"

namespace thawslide::verification {
namespace {

struct Deposit {
  double runout;  // (final length - initial) over initial
  double height;  // at the wall, over the initial width
};

// A column against a smooth wall, 10 m wide.
Deposit collapse(double aspect, const Sets& more = {}) {
  const Sets sets = fmt::format("body.column.max=[10,{}]; time.end={}", 10.0 * aspect, 5.0 * std::sqrt(aspect));
  Simulation<2> simulation(published_case("sand", sets + more));
  run_until(simulation, simulation.parameters().time.end);
  EXPECT_LT(history_value(simulation, "mean_velocity_m_s"), 0.1) << "the column has come to rest";
  const auto& particles = simulation.particles();
  const double height = greatest_of(simulation, [&](std::size_t p) {
    return particles.position(p, 0) < 1.25 ? particles.position(p, 1) - 2.5 : 0.0;
  });
  return {history_value(simulation, "front_position_m") / 10.0 - 1.0, height / 10.0};
}

// Lube et al. 2005, quasi-two-dimensional columns.
double runout_of_lube(double aspect) { return aspect < 1.8 ? 1.2 * aspect : 1.9 * std::pow(aspect, 2.0 / 3.0); }
double height_of_lube(double aspect) { return aspect < 1.15 ? aspect : std::pow(aspect, 0.4); }

TEST(GranularColumn, RunoutAgreesWithExperiments) {
  Record record("Collapse of granular columns",
                "Columns 10 m wide and of aspect ratio 0.5 to 6 collapse. The friction angle is 31 degrees along the "
                "ground and 36.9 inside, which is equivalent on slip planes without dilation. Tall columns leave less "
                "height than sand, because friction is the only loss in their fall here. On finer cells, columns of "
                "aspect ratio 1 travel further (docs/laboratory.md).",
                "runout over width 1.2 a, above a = 1.8 1.9 a^(2/3); height over width a, above a = 1.15 a^0.4",
                "fits to experiments, Lube et al. 2005");
  Curve curve{"aspect ratio", "runout over width", {}, {}, {}, "fit to experiments"};
  for (const double aspect : {0.5, 1.0, 1.5, 3.0, 6.0}) {
    const Deposit deposit = collapse(aspect);
    add_point(curve, aspect, deposit.runout, runout_of_lube(aspect));
    record.expect_near(fmt::format("runout over width, aspect ratio {}", aspect), deposit.runout,
                       runout_of_lube(aspect), 0.2 * runout_of_lube(aspect));
    record.expect_near(fmt::format("height over width, aspect ratio {}", aspect), deposit.height,
                       height_of_lube(aspect), (aspect < 2.0 ? 0.1 : 0.3) * height_of_lube(aspect));
  }
  record.draw(curve);
}

// Early contact ejects grains, and separated material that bears stress immediately expands.
TEST(GranularColumn, NeedsTheDistanceCheckAndGapsThatClose) {
  const double both = collapse(1.0).runout;
  const double neither = collapse(1.0, "material.sand.gaps_close_first=false; basal.distance_check=false").runout;
  EXPECT_GT(neither, 1.5 * both);
  const double affine = collapse(1.0, "mechanics.transfer=apic").runout;
  EXPECT_NEAR(both, affine, 0.15 * affine) << "with both, the transfer has little effect";
}

// Ritter (1892), on a slope Mangeney et al. (2000): behind the front at x = L + a t^2/2 + 2 c t, c = sqrt(g cos h), the
// depth is (front - x)^2/(9 g cos t^2), so that the volume beyond x is (front - x)^3/(27 g cos t^2).
void expect_thin_flow_of_a_dam_break(Record& record, double slope) {
  constexpr double length = 60.0, depth = 5.0;
  const double across = gravity * std::cos(slope * degree), along = gravity * std::sin(slope * degree);
  const Sets sets{"material.sand.friction_angle=0; material.sand.tension_cutoff=0; grid.cell=0.5; grid.max=[180,20]",
                  "time.step=0.0025; time.end=4; basal.friction_angle=0",
                  fmt::format("body.column.max=[{},{}]; case.gravity_tilt={}", length, depth, slope)};
  Simulation<2> simulation(published_case("sand", sets));
  Curve curve{"volume beyond (share of all)", "place (m)", {}, {}, {}};
  for (const double time : {2.0, 4.0}) {
    run_until(simulation, time);
    const auto& particles = simulation.particles();
    std::vector<double> positions = of_particles(simulation, [&](std::size_t p) { return particles.position(p, 0); });
    std::sort(positions.begin(), positions.end());
    const double front = length + 0.5 * along * time * time + 2.0 * std::sqrt(across * depth) * time;
    for (const double fraction : {0.005, 0.02, 0.05, 0.1}) {
      const double behind = std::cbrt(27.0 * across * time * time * fraction * length * depth);
      const double position =
          positions[static_cast<std::size_t>((1.0 - fraction) * static_cast<double>(positions.size()))];
      if (time > 3.0) {
        add_point(curve, fraction, position, front - behind);
      }
      record.expect_near(
          fmt::format("place with {} of the volume beyond, less the dam's, {} degrees, {} s", fraction, slope, time),
          position - length, front - behind - length, 0.06 * (front - length));
    }
  }
  record.draw(curve);
}

TEST(DamBreak, AgreesWithTheThinFlowOfRitter) {
  Record record("Dry dam break",
                "Material without strength, 5 m deep and 60 m long, is released at its front on smooth ground. The "
                "ground is level, or slopes by 20 degrees; on the slope all of the material slides as it spreads.",
                "front at 2 c t + g sin t^2/2, c = sqrt(g cos h); depth (front - x)^2/(9 g cos t^2)",
                "Ritter 1892; Mangeney et al. 2000");
  expect_thin_flow_of_a_dam_break(record, 0.0);
  expect_thin_flow_of_a_dam_break(record, 20.0);
}

TEST(CylindricalColumn, RunoutAgreesWithExperiments) {
  using namespace cylinder_column;
  Record record = make_record("Collapse of a cylindrical granular column");
  expect_runout(record, 1.0);
}

// The front is thinner than a cell. The runout is therefore shorter than that of the experiments by Lube et al., both
// in 3D and in a section (docs/laboratory.md).
TEST(CylinderSection, ApproachesTheExperimentsOnFinerCells) {
  using namespace cylinder_column;
  Record record = make_section_record("Collapse of a cylindrical granular column on finer cells");
  expect_approach(record, {8, 16, 32}, {0.55, 0.40, 0.15});
  record.expect_near("section less column in space, 8 cells",
                     runout_of_section(8, "apic") - cylinder_column::collapse(1.0, radius / 8, "apic"), 0.0, 0.06);
}

TEST(BarCollapse, EndsNearTheMeasuredSurface) {
  using namespace bar_collapse;
  Record record = make_record("Collapse of a column of aluminium bars");
  for (const std::string transfer : {"flip", "apic"}) {
    expect_measured(record, 0.01, transfer, false);
    expect_measured(record, 0.005, transfer, transfer == "apic");
  }
}

}  // namespace
}  // namespace thawslide::verification
