// Parameters of the erodible bed: [bed].
#include "config/table_declaration.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

bool is_erodible(const Case&, const Bed& bed) { return bed.law != BedLaw::none; }

const char* const when_erodible = "when bed.law is not \"none\"";

std::vector<Parameter<Bed>> law_parameters() {
  return {
      parameter(&Bed::law,
                {.key = "law", .text = "law of entrainment", .source = "Iverson (2012); Iverson and Ouyang (2015)"}),
      parameter(
          &Bed::depth,
          {.key = "depth",
           .unit = "m",
           .range = at_least(0),
           .text =
               "vertical depth of the bed, at most grid.cell; an attribute is that of the polygons of bed.outline; the "
               "terrain is not lowered where the bed is entrained"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::strength, {.key = "strength",
                                 .unit = "Pa",
                                 .range = at_least(0),
                                 .text = "shear strength c_b of the bed without load",
                                 .source = "Iverson (2012)"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::friction_angle, {.key = "friction_angle",
                                       .unit = "degrees",
                                       .range = {.low = 0, .high = 90, .high_open = true},
                                       .text = "friction angle of the bed, which adds strength under load"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::depth_per_slip,
                {.key = "depth_per_slip",
                 .range = above(0),
                 .text = "entrained depth per slip [m/m] if the bed yields; with the law \"momentum\", its maximum"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
  };
}

std::vector<Parameter<Bed>> bed_area_parameters() {
  const auto has_outline = [](const Case&, const Bed& bed) { return bed.law != BedLaw::none && !bed.outline.empty(); };
  const char* const when_outline = "when bed.law is not \"none\" and outline is given";
  return {
      parameter(&Bed::outline, {.key = "outline",
                                .text = "file of the polygons that the bed covers: Shapefile, GeoPackage or GeoJSON",
                                .dimension = 3,
                                .is_path = true})
          .otherwise("the bed covers the domain")
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::polygons,
                {.key = "polygons", .text = "names of the polygons that the bed covers; []: all polygons of the file"})
          .only_if(when_outline, "outline", has_outline),
      parameter(&Bed::name_attribute,
                {.key = "name_attribute", .text = "attribute that contains the names of the polygons"})
          .only_if(when_outline, "outline", has_outline),
  };
}

std::vector<Parameter<Bed>> bed_material_parameters() {
  return {
      parameter(&Bed::material, {.key = "material", .text = "name of the bed's material"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::temperature, {.key = "temperature",
                                    .unit = "C",
                                    .range = {.low = -273.15, .high = 100, .low_open = true},
                                    .text = "temperature of the bed; ice and water follow from the freezing curve"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::porosity, {.key = "porosity",
                                 .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
                                 .text = "porosity n of the bed: volume fraction of ice and water",
                                 .source = "Lei et al., Eq. 1"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::particles_per_axis,
                {.key = "particles_per_axis",
                 .range = between(1, 16),
                 .text = "number of particles of entrained material per cell along each axis"})
          .only_if(when_erodible, "law", is_erodible),
  };
}

}  // namespace

void declare_bed(Tables& tables) {
  std::vector<Parameter<Bed>> parameters = law_parameters();
  for (const auto& more : {bed_area_parameters(), bed_material_parameters()}) {
    parameters.insert(parameters.end(), more.begin(), more.end());
  }
  tables.push_back(std::make_unique<SingleTable<Bed>>("bed", "Erodible bed of ice or debris on the terrain", &Case::bed,
                                                      std::move(parameters)));
}

}  // namespace thawslide::config
