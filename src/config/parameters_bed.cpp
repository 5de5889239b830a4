// Parameters of the erodible bed: [bed].
#include "config/table_declaration.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

bool is_erodible(const Case&, const Bed& bed) { return bed.law != BedLaw::none; }

const char* const when_erodible = "when bed.law is not \"none\"";

std::vector<Parameter<Bed>> law_parameters() {
  return {
      parameter(&Bed::law, {.key = "law",
                            .text = "how the slide entrains the bed on the ground",
                            .source = "Iverson 2012; Iverson and Ouyang 2015"}),
      parameter(&Bed::depth, {.key = "depth",
                              .unit = "m",
                              .range = at_least(0),
                              .text = "depth of the bed, along the vertical: at most grid.cell; the ground that it "
                                      "lies on stays where terrain has it"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::strength, {.key = "strength",
                                 .unit = "Pa",
                                 .range = at_least(0),
                                 .text = "shear strength of the bed without load, c_b",
                                 .source = "Iverson 2012"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::friction_angle, {.key = "friction_angle",
                                       .unit = "degrees",
                                       .range = {.low = 0, .high = 90, .high_open = true},
                                       .text = "friction angle of the bed, which adds strength under load"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::depth_per_slip, {.key = "depth_per_slip",
                                       .range = above(0),
                                       .text = "depth entrained per slip where the bed yields [m/m]; with the law "
                                               "\"momentum\" the largest"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
  };
}

std::vector<Parameter<Bed>> bed_material_parameters() {
  return {
      parameter(&Bed::material, {.key = "material", .text = "name of the material that the bed is made of"})
          .required_if(when_erodible, is_erodible)
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::temperature, {.key = "temperature",
                                    .unit = "C",
                                    .range = {.low = -273.15, .high = 100, .low_open = true},
                                    .text = "temperature of the bed; ice and water follow by the freezing curve"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::porosity, {.key = "porosity",
                                 .range = {.low = 0, .high = physics::largest_porosity, .low_open = true},
                                 .text = "porosity n of the bed: share of ice and water in the volume",
                                 .source = "Eq. 1"})
          .only_if(when_erodible, "law", is_erodible),
      parameter(&Bed::particles_per_axis,
                {.key = "particles_per_axis",
                 .range = between(1, 16),
                 .text = "size of the particles of entrained material: number per cell along each axis"})
          .only_if(when_erodible, "law", is_erodible),
  };
}

}  // namespace

void declare_bed(Tables& tables) {
  std::vector<Parameter<Bed>> parameters = law_parameters();
  for (auto& more : bed_material_parameters()) {
    parameters.push_back(std::move(more));
  }
  tables.push_back(std::make_unique<SingleTable<Bed>>("bed", "Ice or debris on the ground that the slide entrains",
                                                      &Case::bed, std::move(parameters)));
}

}  // namespace thawslide::config
