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
               "vertical depth of the bed, at most grid.cell; the terrain is not lowered where the bed is entrained"})
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
  for (auto& more : bed_material_parameters()) {
    parameters.push_back(std::move(more));
  }
  tables.push_back(std::make_unique<SingleTable<Bed>>("bed", "Erodible bed of ice or debris on the terrain", &Case::bed,
                                                      std::move(parameters)));
}

}  // namespace thawslide::config
