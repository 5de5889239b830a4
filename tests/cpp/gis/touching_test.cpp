// Bodies whose outlines share an edge: each keeps its volume, without overlaps or gaps between them.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/raster.hpp"
#include "config/read_case.hpp"
#include "sim/simulation.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

constexpr double spacing = 2.5;  // of particles [m]

// "ice" and "rock" of two materials on the plane, whose points are 5 m apart; `more`: lines added to both.
config::Case touching_case(const std::string& ice, const std::string& rock, double ice_thickness, double rock_thickness,
                           const std::string& more = "") {
  geotiff("dem.tif", ground());
  geojson("ice.geojson", {{"", ice}});
  geojson("rock.geojson", {{"", rock}});
  const std::string material = "law = \"elastic\"\nyoungs_modulus = 1e8\npoisson_ratio = 0.2\n";
  std::string text = "[case]\ndimension = 3\n[time]\nend = 1.0\nstepping = \"adaptive\"\n" +
                     fmt::format("[grid]\ncell = 5.0\nmin = [{}, {}, 1000.0]\nmax = [{}, {}, 2500.0]\n", west + 100.0,
                                 south + 100.0, west + 900.0, south + 700.0) +
                     "[terrain]\ntype = \"dem\"\nfile = \"dem.tif\"\n[basal]\nfriction_angle = 20.0\n" +
                     "[material.granite]\n" + material + "[material.firn]\n" + material;
  for (const auto& [name, material, thickness] :
       {std::tuple("ice", "firn", ice_thickness), std::tuple("rock", "granite", rock_thickness)}) {
    text +=
        fmt::format("[body.{0}]\nmaterial = \"{1}\"\nshape = \"release\"\nrelease = \"{0}.geojson\"\nthickness = {2}\n",
                    name, material, thickness) +
        more;
  }
  return config::read_case(text_file("case.toml", text), {});
}

struct Column {
  std::set<int> bodies;
  double top = 0.0;     // of the highest particle [m]
  double volume = 0.0;  // [m3]
};

struct Seeded {
  std::map<std::pair<long, long>, Column>
      columns;                      // by position in units of half a spacing from the ground's first point
  std::array<double, 2> volumes{};  // of ice and rock [m3]
  std::array<std::set<int>, 2> materials;
  double nearest = HUGE_VAL;  // horizontal distance of particles of two bodies [m]
};

Seeded seeded(const config::Case& parameters) {
  const sim::Simulation<3> simulation(parameters, load_site(parameters).site);
  const auto& particles = simulation.particles();
  Seeded found;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position(p, 0) + simulation.model().origin[0] - west;
    const double y = particles.position(p, 1) + simulation.model().origin[1] - south;
    Column& column = found.columns[{std::lround(2.0 * x / spacing), std::lround(2.0 * y / spacing)}];
    column.bodies.insert(particles.body(p));
    column.volume += particles.volume(p);
    const auto body = static_cast<std::size_t>(particles.body(p));
    found.volumes[body] += particles.volume(p);
    found.materials[body].insert(particles.material(p));
  }
  for (const auto& [place, column] : found.columns) {
    for (const auto& [other_place, other] : found.columns) {
      if (column.bodies != other.bodies) {
        found.nearest = std::min(found.nearest, 0.5 * spacing *
                                                    std::hypot(static_cast<double>(place.first - other_place.first),
                                                               static_cast<double>(place.second - other_place.second)));
      }
    }
  }
  return found;
}

// Body of the column at a position, and its thickness [m]; -1 and 0 if there are none or several.
std::pair<int, double> at(const Seeded& found, double x, double y) {
  const auto column = found.columns.find({std::lround(2.0 * x / spacing), std::lround(2.0 * y / spacing)});
  if (column == found.columns.end() || column->second.bodies.size() != 1) {
    return {-1, 0.0};
  }
  return {*column->second.bodies.begin(), column->second.volume / (spacing * spacing)};
}

// Every column within the box [from, to) belongs to body_at(x, y), and has its thickness except for the rounding of
// volumes. Returns the number of columns of ice.
template <class BodyAt>
int expect_columns(const Seeded& found, std::array<double, 2> from, std::array<double, 2> to, const BodyAt& body_at,
                   const std::array<double, 2>& thickness, const std::array<double, 2>& tolerance) {
  int of_ice = 0;
  for (double y = from[1] + 0.5 * spacing; y < to[1]; y += spacing) {
    for (double x = from[0] + 0.5 * spacing; x < to[0]; x += spacing) {
      const auto [there, found_thickness] = at(found, x, y);
      const auto body = static_cast<std::size_t>(body_at(x, y));
      EXPECT_EQ(there, static_cast<int>(body)) << x << ", " << y;
      EXPECT_NEAR(found_thickness, thickness[body], tolerance[body] * thickness[body]) << x << ", " << y;
      of_ice += body == 0 ? 1 : 0;
    }
  }
  return of_ice;
}

void expect_filled(const Seeded& found, std::array<double, 2> from, std::array<double, 2> to, int body,
                   double thickness, double tolerance) {
  expect_columns(found, from, to, [=](double, double) { return body; }, {thickness, thickness}, {tolerance, tolerance});
}

constexpr int ice = 0, rock = 1;

// On points of the ground, and between them. Columns whose centre is within the outline count: an edge between points
// is resolved to half a column, which changes volumes by 1 %.
TEST(TouchingTest, TwoRectanglesThatShareAnEdge) {
  for (const auto& [edge, columns_until, tolerance] :
       {std::tuple(400.0, 400.0, 0.01), std::tuple(401.7, 402.5, 0.012)}) {
    const Seeded found = seeded(touching_case(box_at(edge, 300, 480, 400), box_at(300, 300, edge, 400), 7.5, 12.0));
    EXPECT_NEAR(found.volumes[ice], (480.0 - edge) * 100.0 * 7.5, 1e-6);
    EXPECT_NEAR(found.volumes[rock], (edge - 300.0) * 100.0 * 12.0, 1e-6);
    EXPECT_EQ(found.materials[ice], std::set<int>{0});
    EXPECT_EQ(found.materials[rock], std::set<int>{1});
    EXPECT_NEAR(found.nearest, spacing, 1e-9);
    // Up to the edge, minus the cell within which the outer edges taper to 0.
    expect_filled(found, {305, 305}, {columns_until, 395}, rock, 12.0, tolerance);
    expect_filled(found, {columns_until, 305}, {475, 395}, ice, 7.5, tolerance);
  }
}

TEST(TouchingTest, AnObliqueEdge) {
  const std::string left = polygon_json(
      {{west + 300, south + 300}, {west + 380, south + 300}, {west + 430, south + 400}, {west + 300, south + 400}});
  const std::string right = polygon_json(
      {{west + 380, south + 300}, {west + 480, south + 300}, {west + 480, south + 400}, {west + 430, south + 400}});
  const Seeded found = seeded(touching_case(right, left, 20.0, 10.0));
  EXPECT_NEAR(found.volumes[ice], 7500.0 * 20.0, 1e-6);
  EXPECT_NEAR(found.volumes[rock], 10500.0 * 10.0, 1e-6);
  EXPECT_GE(found.nearest, spacing * (1.0 - 1e-9));
  const auto body_at = [](double x, double y) { return x < 380.0 + 0.5 * (y - 300.0) ? rock : ice; };
  expect_columns(found, {305, 305}, {475, 395}, body_at, {20.0, 10.0}, {0.01, 0.01});
}

TEST(TouchingTest, OneFillsAHoleOfTheOther) {
  const std::string outer = box_at(300, 300, 400, 400), inner = box_at(332, 333, 352, 363);
  // The ring of the inner body is the hole of the outer one.
  const std::string ring = inner.substr(inner.find("[[") + 1, inner.rfind("]}") - inner.find("[[") - 1);
  const std::string with_hole = outer.substr(0, outer.rfind("]}")) + "," + ring + "]}";
  const Seeded found = seeded(touching_case(inner, with_hole, 5.0, 25.0));
  EXPECT_NEAR(found.volumes[ice], 20.0 * 30.0 * 5.0, 1e-6);
  EXPECT_NEAR(found.volumes[rock], (1e4 - 600.0) * 25.0, 1e-6);
  EXPECT_NEAR(found.nearest, spacing, 1e-9);
  const auto body_at = [](double x, double y) { return x > 332 && x < 352 && y > 333 && y < 363 ? ice : rock; };
  EXPECT_EQ(expect_columns(found, {305, 305}, {395, 395}, body_at, {5.0, 25.0}, {0.02, 0.02}), 8 * 12);
}

// Cut out with tapers: the outer edges are inclined, the shared one is not.
TEST(TouchingTest, CutOutWithATaper) {
  const config::Case parameters = touching_case(box_at(400, 300, 480, 400), box_at(300, 300, 400, 400), 7.5, 12.0,
                                                "placement = \"cut\"\ntaper = 40.0\n");
  const config::Site site = load_site(parameters).site;
  const double rock_volume = volume_of(site.releases.at("rock").thickness);
  EXPECT_NEAR(rock_volume, 1e4 * 12.0, 1e-6);
  EXPECT_NEAR(volume_of(site.releases.at("ice").thickness), 8e3 * 7.5, 1e-6);
  const auto cut_at = [&](double x, double y) {
    const auto column = static_cast<int>(std::lround((west + x - site.ground->x) / 5.0));
    const auto row = static_cast<int>(std::lround((south + y - site.ground->y) / 5.0));
    return plane(west + x, south + y) - site.ground->at(column, row);
  };
  EXPECT_NEAR(cut_at(350, 350), 12.0, 0.01 * 12.0);
  EXPECT_NEAR(cut_at(395, 350), 12.0, 0.01 * 12.0);
  EXPECT_NEAR(cut_at(400, 350), 9.75, 0.01 * 9.75);
  EXPECT_NEAR(cut_at(405, 350), 7.5, 0.01 * 7.5);
  EXPECT_NEAR(cut_at(300, 350), 6.0, 0.01 * 6.0);
  const Seeded found = seeded(parameters);
  EXPECT_NEAR(found.volumes[ice], 8e3 * 7.5, 1e-6);
  EXPECT_NEAR(found.volumes[rock], 1e4 * 12.0, 1e-6);
  expect_filled(found, {325, 325}, {400, 375}, rock, 12.0, 0.01);
  expect_filled(found, {400, 325}, {455, 375}, ice, 7.5, 0.01);
}

TEST(TouchingTest, ARasterNextToAPolygon) {
  config::Case parameters = touching_case(box_at(400, 300, 480, 400), box_at(300, 300, 400, 400), 7.5, 12.0);
  // The cells of its points extend from 302.5 to 402.5; the polygon begins there.
  geojson("ice.geojson", {{"", box_at(402.5, 302.5, 480, 402.5)}});
  const auto thickness = [](double x, double y) {
    return std::abs(x - west - 352.5) < 50.0 && std::abs(y - south - 352.5) < 50.0 ? 12.0 : 0.0;
  };
  parameters.bodies["rock"].release = "";
  parameters.bodies["rock"].thickness = {config::MapValue::From::raster, 0.0,
                                         geotiff("thick.tif", raster_of(thickness, west, south, 5.0, 201, 161))};
  const Seeded found = seeded(parameters);
  EXPECT_NEAR(found.volumes[ice], 77.5 * 100.0 * 7.5, 1e-6);
  EXPECT_NEAR(found.volumes[rock], 1e4 * 12.0, 1e-6);
  expect_filled(found, {307.5, 307.5}, {402.5, 397.5}, rock, 12.0, 0.01);
  expect_filled(found, {402.5, 307.5}, {475, 397.5}, ice, 7.5, 0.01);
}

TEST(TouchingTest, DistantBodiesAreUnchanged) {
  const config::Site site =
      load_site(touching_case(box_at(410, 300, 480, 400), box_at(300, 300, 400, 400), 7.5, 12.0)).site;
  for (const auto& [name, release] : site.releases) {
    EXPECT_TRUE(release.assigned_thickness.empty() && release.claim.empty()) << name;
  }
}

TEST(TouchingTest, TapersMustBeTheSame) {
  config::Case parameters = touching_case(box_at(400, 300, 480, 400), box_at(300, 300, 400, 400), 7.5, 12.0);
  parameters.bodies["ice"].taper = 30.0;
  parameters.locations["body.rock.taper"] = "case.toml:30:9";
  expect_message(error_of_site(parameters));
}

TEST(TouchingTest, OverlapsAreReported) {
  config::Case parameters = plain_case(ground());
  const auto with = [&](const std::string& snow) {
    parameters.bodies["rock"] = release_body(geojson("rock.geojson", {{"", box_at(300, 300, 400, 400)}}), 10.0);
    parameters.bodies["snow"] = release_body(geojson("snow.geojson", {{"", snow}}), 3.0);
    return error_of_site(parameters);
  };
  expect_message(with(box_at(390, 380, 450, 450)));
  EXPECT_EQ(with(box_at(400, 380, 450, 450)), "no error");
  EXPECT_EQ(with(box_at(399.95, 300, 450, 400)), "no error");
  EXPECT_NE(with(box_at(399.9, 300, 450, 400)).find("overlap by 10 m2"), std::string::npos);
}

}  // namespace
}  // namespace thawslide::gis
