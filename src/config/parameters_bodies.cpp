// Parameters of bodies, frames and initial particle positions: [body.NAME], [frame.NAME], [initial].
#include <limits>

#include "config/table_declaration.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

bool is_release(const Case&, const Body& body) { return body.shape == BodyShape::release; }
bool is_no_release(const Case&, const Body& body) { return body.shape != BodyShape::release; }
bool has_polygons(const Case&, const Body& body) { return body.shape == BodyShape::release && !body.release.empty(); }

const char* const when_release = "when the shape is \"release\"";

std::vector<Parameter<Body>> shape_parameters() {
  const auto is_box = [](const Case&, const Body& body) { return body.shape == BodyShape::box; };
  const auto is_polygon = [](const Case&, const Body& body) { return body.shape == BodyShape::polygon; };
  const std::string when_box = "when the shape is \"box\"";
  const std::string when_no_release = "when the shape is not \"release\"";
  return {
      parameter(&Body::material, {.key = "material", .text = "name of the material the body is made of"}).required(),
      parameter(&Body::shape, {.key = "shape", .text = "how the place and form of the body are given"}),
      parameter(&Body::min, {.key = "min", .unit = "m", .text = "lowest corner of the box"})
          .required_if(when_box, is_box)
          .only_if(when_no_release, "shape", is_no_release),
      parameter(&Body::max, {.key = "max", .unit = "m", .text = "highest corner of the box"})
          .required_if(when_box, is_box)
          .only_if(when_no_release, "shape", is_no_release),
      parameter(&Body::vertices,
                {.key = "vertices", .unit = "m", .text = "corners of the polygon, in order", .dimension = 2})
          .required_if("when the shape is \"polygon\"", is_polygon),
  };
}

std::vector<Parameter<Body>> release_parameters() {
  const auto needs_polygons = [](const Case&, const Body& body) {
    const bool by_polygons =
        body.thickness.from == MapValue::From::number || body.thickness.from == MapValue::From::attribute;
    return body.shape == BodyShape::release && by_polygons;
  };
  const std::string when_polygons = "when the shape is \"release\" and release is given";
  return {
      parameter(&Body::release, {.key = "release",
                                 .text = "file of polygons that bound the body: Shapefile, GeoPackage or GeoJSON",
                                 .is_path = true})
          .required_if("when the shape is \"release\" and thickness is a number or an attribute", needs_polygons)
          .only_if(when_release, "shape", is_release),
      parameter(&Body::polygons, {.key = "polygons",
                                  .text = "names of the polygons that make up the body together; []: all of the file"})
          .only_if(when_polygons, "release", has_polygons),
      parameter(&Body::name_attribute, {.key = "name_attribute", .text = "attribute that holds the polygons' names"})
          .only_if(when_polygons, "release", has_polygons),
      parameter(
          &Body::thickness,
          {.key = "thickness",
           .unit = "m",
           .range = above(0),
           .text = "thickness of the body: a number, an attribute of the polygons, a raster of it, or a raster of "
                   "the surface before the slide, from which the DEM is subtracted"})
          .required_if(when_release, is_release)
          .only_if(when_release, "shape", is_release),
      parameter(&Body::thickness_along, {.key = "thickness_along", .text = "direction in which thickness is measured"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::placement, {.key = "placement", .text = "where the body lies"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::taper, {.key = "taper",
                               .unit = "m",
                               .range = at_least(0),
                               .text = "width along the edge over which the thickness falls to 0"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::surface_tolerance,
                {.key = "surface_tolerance",
                 .unit = "m",
                 .range = at_least(0),
                 .text = "noise of the surface before the slide and the DEM: a difference up to it counts as none, and "
                         "within polygons the surface may lie so far below the DEM"})
          .only_if("when the shape is \"release\" and thickness is a surface", "thickness",
                   [](const Case&, const Body& body) {
                     return body.shape == BodyShape::release && body.thickness.from == MapValue::From::surface;
                   }),
      parameter(&Body::largest_volume,
                {.key = "largest_volume",
                 .unit = "m3",
                 .range = above(0),
                 .text = "largest volume of the body: a larger release must be confirmed by a larger value"})
          .only_if(when_release, "shape", is_release),
  };
}

std::vector<Parameter<Body>> start_parameters() {
  return {
      parameter(&Body::particles_per_axis, {.key = "particles_per_axis",
                                            .range = between(1, 16),
                                            .text = "particles per cell along each axis: 2 gives 4 per cell in 2D"}),
      parameter(&Body::temperature, {.key = "temperature",
                                     .unit = "C",
                                     .range = {.low = -273.15, .high = 100, .low_open = true},
                                     .text = "temperature at t = 0; depth is vertical, below the body's surface [m]"})
          .only_if("when saturation is not given, from which it follows by the freezing curve", "saturation",
                   [](const Case&, const Body& body) { return !body.saturation.is_given(); }),
      parameter(&Body::saturation,
                {.key = "saturation",
                 .range = between(0, 1),
                 .text = "liquid saturation at t = 0: share of water in the pores, instead of a temperature",
                 .source = "Eq. 24"})
          .otherwise("what the freezing curve gives at temperature"),
      parameter(&Body::porosity, {.key = "porosity",
                                  .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
                                  .text = "porosity n at t = 0: share of ice and water in the volume",
                                  .source = "Eq. 1, Table 2"})
          .only_if("when ice_content is not given, from which it follows", "ice_content",
                   [](const Case&, const Body& body) { return !body.ice_content.is_given(); }),
      parameter(&Body::ice_content,
                {.key = "ice_content",
                 .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
                 .text = "share of ice in the volume at t = 0, instead of a porosity, which is then ice_content / (1 - "
                         "saturation)",
                 .source = "Eq. 1"})
          .otherwise("what porosity and saturation make"),
      parameter(&Body::velocity, {.key = "velocity", .unit = "m/s", .text = "velocity at t = 0"}),
  };
}

std::vector<Parameter<Body>> body_parameters() {
  std::vector<Parameter<Body>> result = shape_parameters();
  for (auto& more : {release_parameters(), start_parameters()}) {
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

std::vector<Parameter<Frame>> frame_parameters() {
  return {
      parameter(&Frame::min, {.key = "min", .unit = "m", .text = "lowest corner of the box at t = 0"}).required(),
      parameter(&Frame::max, {.key = "max", .unit = "m", .text = "highest corner of the box at t = 0"}).required(),
      parameter(&Frame::axis, {.key = "axis",
                               .text = "the velocity component that is prescribed inside the box",
                               .words = {{"x", "along x"}, {"y", "along y, up in 2D"}, {"z", "along z, up in 3D"}}})
          .required(),
      parameter(&Frame::velocity, {.key = "velocity",
                                   .unit = "m/s",
                                   .text = "the prescribed velocity, with which the box moves",
                                   .source = "Sec. 3.2"})
          .required(),
  };
}

std::vector<Parameter<Initial>> initial_parameters() {
  return {
      parameter(&Initial::noise,
                {.key = "noise",
                 .range = {.low = 0, .high = 0.5, .high_open = true},
                 .text = "largest displacement at random of a particle from its regular place, either way along each "
                         "axis, as a share of the distance of particles; one that would leave its body keeps its "
                         "place; 0: none"}),
      parameter(&Initial::seed,
                {.key = "seed",
                 .range = between(0, static_cast<double>(std::numeric_limits<int>::max())),
                 .text = "number from which the displacements follow: another one, other displacements"})
          .only_if("when initial.noise is above 0", "noise",
                   [](const Case&, const Initial& initial) { return initial.noise > 0.0; }),
  };
}

}  // namespace

void declare_bodies(Tables& tables) {
  tables.push_back(std::make_unique<NamedTable<Body>>("body", "A body of particles, by a name of your choice",
                                                      &Case::bodies, body_parameters()));
  tables.push_back(std::make_unique<NamedTable<Frame>>("frame", "A rigid box that prescribes one velocity component",
                                                       &Case::frames, frame_parameters()));
  tables.push_back(std::make_unique<SingleTable<Initial>>("initial", "Positions of particles at t = 0", &Case::initial,
                                                          initial_parameters()));
}

}  // namespace thawslide::config
