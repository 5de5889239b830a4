// Parameters of bodies, frames and initial particle positions: [body.NAME], [frame.NAME], [initial].
#include <limits>

#include "config/table_declaration.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

void declare_body(Tables& tables) {
  const auto box = if_is(&Body::shape, BodyShape::box, "the shape", "shape");
  const auto polygon = if_is(&Body::shape, BodyShape::polygon, "the shape", "shape");
  const auto release = if_is(&Body::shape, BodyShape::release, "the shape", "shape");
  const Condition<Body> no_release{"when the shape is not \"release\"", "shape",
                                   [](const Case&, const Body& body) { return body.shape != BodyShape::release; }};
  const Condition<Body> polygons{
      "when the shape is \"release\" and release is given", "release",
      [](const Case&, const Body& body) { return body.shape == BodyShape::release && !body.release.empty(); }};
  declare(
      tables, "body", "A body of particles with a name of your choice", &Case::bodies,
      {parameter(&Body::material, "material", "name of the body's material").required(),
       parameter(&Body::shape, "shape", "geometry of the body"),
       parameter(&Body::min, "min", "m", {}, "minimum coordinates of the box").required_if(box).only_if(no_release),
       parameter(&Body::max, "max", "m", {}, "maximum coordinates of the box").required_if(box).only_if(no_release),
       parameter(&Body::vertices, "vertices", "m", {}, "vertices of the polygon, in order", {.dimension = 2})
           .required_if(polygon),
       parameter(&Body::release, "release", "file of the release polygons: Shapefile, GeoPackage or GeoJSON",
                 {.is_path = true})
           .required_if("when the shape is \"release\" and thickness is a number or an attribute",
                        [](const Case&, const Body& body) {
                          const bool by_polygons = body.thickness.from == MapValue::From::number ||
                                                   body.thickness.from == MapValue::From::attribute;
                          return body.shape == BodyShape::release && by_polygons;
                        })
           .only_if(release),
       parameter(&Body::polygons, "polygons", "names of the polygons that form the body; []: all polygons of the file")
           .only_if(polygons),
       parameter(&Body::name_attribute, "name_attribute", "attribute that contains the names of the polygons")
           .only_if(polygons),
       parameter(&Body::thickness, "thickness", "m", above(0),
                 "release thickness: a number, an attribute of the polygons, a raster of thickness, or a raster of the "
                 "surface before the event, from which the DEM is subtracted")
           .required_if(release)
           .only_if(release),
       parameter(&Body::thickness_along, "thickness_along", "direction of the thickness").only_if(release),
       parameter(&Body::placement, "placement", "position of the body relative to the DEM").only_if(release),
       parameter(&Body::taper, "taper", "m", at_least(0),
                 "width of the edge zone in which the thickness decreases to 0")
           .only_if(release),
       parameter(&Body::surface_tolerance, "surface_tolerance", "m", at_least(0),
                 "vertical noise of surface and DEM: thinner material counts as zero, and within polygons the surface "
                 "may be this far below the DEM")
           .only_if({"when the shape is \"release\" and thickness is a surface", "thickness",
                     [](const Case&, const Body& body) {
                       return body.shape == BodyShape::release && body.thickness.from == MapValue::From::surface;
                     }}),
       parameter(&Body::largest_volume, "largest_volume", "m3", above(0),
                 "maximum volume of the body; a larger release must be confirmed by a larger value")
           .only_if(release),
       parameter(&Body::particles_per_axis, "particles_per_axis", "", between(1, 16),
                 "number of particles per cell along each axis; 2 gives 4 per cell in 2D, 8 in 3D"),
       parameter(&Body::temperature, "temperature", "C", {.low = -273.15, .high = 100, .low_open = true},
                 "temperature at t = 0; depth is vertical, below the surface of the body [m]")
           .only_if({"when saturation is not given", "saturation",
                     [](const Case&, const Body& body) { return !body.saturation.is_given(); }}),
       parameter(&Body::saturation, "saturation", "", between(0, 1),
                 "liquid saturation at t = 0, instead of temperature: fraction of the pores that is filled with water",
                 {.source = "Lei et al., Eq. 24"})
           .otherwise("from temperature by the freezing curve"),
       parameter(&Body::porosity, "porosity", "", {.low = 0, .high = physics::largest_porosity, .low_open = true},
                 "porosity n at t = 0: volume fraction of ice and water", {.source = "Lei et al., Eq. 1, Table 2"})
           .only_if({"when ice_content is not given", "ice_content",
                     [](const Case&, const Body& body) { return !body.ice_content.is_given(); }}),
       parameter(&Body::ice_content, "ice_content", "", {.low = 0, .high = physics::largest_porosity, .low_open = true},
                 "volume fraction of ice at t = 0, instead of porosity, which is then ice_content / (1 - saturation)",
                 {.source = "Lei et al., Eq. 1"})
           .otherwise("from porosity and saturation"),
       parameter(&Body::velocity, "velocity", "m/s", {}, "velocity at t = 0"),
       parameter(&Body::release_time, "release_time", "s", at_least(0),
                 "time until which the body is held in place, as a wall without tension for other bodies; an attribute "
                 "has one value for all polygons of the body")});
}

}  // namespace

void declare_bodies(Tables& tables) {
  declare_body(tables);
  declare(tables, "frame", "A rigid box with a name of your choice, in which one velocity component is prescribed",
          &Case::frames,
          {parameter(&Frame::min, "min", "m", {}, "minimum coordinates of the box at t = 0").required(),
           parameter(&Frame::max, "max", "m", {}, "maximum coordinates of the box at t = 0").required(),
           parameter(&Frame::axis, "axis", "velocity component that is prescribed inside the box",
                     {.keywords = {{"x", "along x"}, {"y", "along y, up in 2D"}, {"z", "along z, up in 3D"}}})
               .required(),
           parameter(&Frame::velocity, "velocity", "m/s", {}, "prescribed velocity component; the box moves with it",
                     {.source = "Lei et al., Sec. 3.2"})
               .required()});
  declare(tables, "initial", "Initial positions of particles", &Case::initial,
          {parameter(&Initial::noise, "noise", "", {.low = 0, .high = 0.5, .high_open = true},
                     "maximum random displacement of particles along each axis, as a fraction of the particle spacing; "
                     "particles that would leave their body are not displaced; 0: none"),
           parameter(&Initial::seed, "seed", "", between(0, static_cast<double>(std::numeric_limits<int>::max())),
                     "seed of the random displacements")
               .only_if({"when initial.noise is above 0", "noise",
                         [](const Case&, const Initial& initial) { return initial.noise > 0.0; }})});
}

}  // namespace thawslide::config
