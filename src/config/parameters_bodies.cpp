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
      parameter(&Body::material, {.key = "material", .text = "name of the body's material"}).required(),
      parameter(&Body::shape, {.key = "shape", .text = "geometry of the body"}),
      parameter(&Body::min, {.key = "min", .unit = "m", .text = "minimum coordinates of the box"})
          .required_if(when_box, is_box)
          .only_if(when_no_release, "shape", is_no_release),
      parameter(&Body::max, {.key = "max", .unit = "m", .text = "maximum coordinates of the box"})
          .required_if(when_box, is_box)
          .only_if(when_no_release, "shape", is_no_release),
      parameter(&Body::vertices,
                {.key = "vertices", .unit = "m", .text = "vertices of the polygon, in order", .dimension = 2})
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
      parameter(
          &Body::release,
          {.key = "release", .text = "file of the release polygons: Shapefile, GeoPackage or GeoJSON", .is_path = true})
          .required_if("when the shape is \"release\" and thickness is a number or an attribute", needs_polygons)
          .only_if(when_release, "shape", is_release),
      parameter(&Body::polygons,
                {.key = "polygons", .text = "names of the polygons that form the body; []: all polygons of the file"})
          .only_if(when_polygons, "release", has_polygons),
      parameter(&Body::name_attribute,
                {.key = "name_attribute", .text = "attribute that contains the names of the polygons"})
          .only_if(when_polygons, "release", has_polygons),
      parameter(&Body::thickness,
                {.key = "thickness",
                 .unit = "m",
                 .range = above(0),
                 .text = "release thickness: a number, an attribute of the polygons, a raster of thickness, or a "
                         "raster of the surface before the event, from which the DEM is subtracted"})
          .required_if(when_release, is_release)
          .only_if(when_release, "shape", is_release),
      parameter(&Body::thickness_along, {.key = "thickness_along", .text = "direction of the thickness"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::placement, {.key = "placement", .text = "position of the body relative to the DEM"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::taper, {.key = "taper",
                               .unit = "m",
                               .range = at_least(0),
                               .text = "width of the edge zone in which the thickness decreases to 0"})
          .only_if(when_release, "shape", is_release),
      parameter(&Body::surface_tolerance,
                {.key = "surface_tolerance",
                 .unit = "m",
                 .range = at_least(0),
                 .text = "vertical noise of surface and DEM: thinner material counts as zero, and within polygons the "
                         "surface may be this far below the DEM"})
          .only_if("when the shape is \"release\" and thickness is a surface", "thickness",
                   [](const Case&, const Body& body) {
                     return body.shape == BodyShape::release && body.thickness.from == MapValue::From::surface;
                   }),
      parameter(&Body::largest_volume,
                {.key = "largest_volume",
                 .unit = "m3",
                 .range = above(0),
                 .text = "maximum volume of the body; a larger release must be confirmed by a larger value"})
          .only_if(when_release, "shape", is_release),
  };
}

std::vector<Parameter<Body>> start_parameters() {
  return {
      parameter(&Body::particles_per_axis,
                {.key = "particles_per_axis",
                 .range = between(1, 16),
                 .text = "number of particles per cell along each axis; 2 gives 4 per cell in 2D, 8 in 3D"}),
      parameter(&Body::temperature,
                {.key = "temperature",
                 .unit = "C",
                 .range = {.low = -273.15, .high = 100, .low_open = true},
                 .text = "temperature at t = 0; depth is vertical, below the surface of the body [m]"})
          .only_if("when saturation is not given", "saturation",
                   [](const Case&, const Body& body) { return !body.saturation.is_given(); }),
      parameter(
          &Body::saturation,
          {.key = "saturation",
           .range = between(0, 1),
           .text =
               "liquid saturation at t = 0, instead of temperature: fraction of the pores that is filled with water",
           .source = "Lei et al., Eq. 24"})
          .otherwise("from temperature by the freezing curve"),
      parameter(&Body::porosity, {.key = "porosity",
                                  .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
                                  .text = "porosity n at t = 0: volume fraction of ice and water",
                                  .source = "Lei et al., Eq. 1, Table 2"})
          .only_if("when ice_content is not given", "ice_content",
                   [](const Case&, const Body& body) { return !body.ice_content.is_given(); }),
      parameter(
          &Body::ice_content,
          {.key = "ice_content",
           .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
           .text = "volume fraction of ice at t = 0, instead of porosity, which is then ice_content / (1 - saturation)",
           .source = "Lei et al., Eq. 1"})
          .otherwise("from porosity and saturation"),
      parameter(&Body::velocity, {.key = "velocity", .unit = "m/s", .text = "velocity at t = 0"}),
      parameter(&Body::release_time,
                {.key = "release_time",
                 .unit = "s",
                 .range = at_least(0),
                 .text = "time until which the body is held in place, as a wall without tension for other bodies; an "
                         "attribute has one value for all polygons of the body"}),
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
      parameter(&Frame::min, {.key = "min", .unit = "m", .text = "minimum coordinates of the box at t = 0"}).required(),
      parameter(&Frame::max, {.key = "max", .unit = "m", .text = "maximum coordinates of the box at t = 0"}).required(),
      parameter(&Frame::axis, {.key = "axis",
                               .text = "velocity component that is prescribed inside the box",
                               .keywords = {{"x", "along x"}, {"y", "along y, up in 2D"}, {"z", "along z, up in 3D"}}})
          .required(),
      parameter(&Frame::velocity, {.key = "velocity",
                                   .unit = "m/s",
                                   .text = "prescribed velocity component; the box moves with it",
                                   .source = "Lei et al., Sec. 3.2"})
          .required(),
  };
}

std::vector<Parameter<Initial>> initial_parameters() {
  return {
      parameter(&Initial::noise,
                {.key = "noise",
                 .range = {.low = 0, .high = 0.5, .high_open = true},
                 .text = "maximum random displacement of particles along each axis, as a fraction of the particle "
                         "spacing; particles that would leave their body are not displaced; 0: none"}),
      parameter(&Initial::seed, {.key = "seed",
                                 .range = between(0, static_cast<double>(std::numeric_limits<int>::max())),
                                 .text = "seed of the random displacements"})
          .only_if("when initial.noise is above 0", "noise",
                   [](const Case&, const Initial& initial) { return initial.noise > 0.0; }),
  };
}

}  // namespace

void declare_bodies(Tables& tables) {
  tables.push_back(std::make_unique<NamedTable<Body>>("body", "A body of particles with a name of your choice",
                                                      &Case::bodies, body_parameters()));
  tables.push_back(std::make_unique<NamedTable<Frame>>(
      "frame", "A rigid box with a name of your choice, in which one velocity component is prescribed", &Case::frames,
      frame_parameters()));
  tables.push_back(std::make_unique<SingleTable<Initial>>("initial", "Initial positions of particles", &Case::initial,
                                                          initial_parameters()));
}

}  // namespace thawslide::config
