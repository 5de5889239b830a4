// Parameters of the base: [basal], [substrate.NAME], [bed], [contact], [contact_pair.NAME]; laws: physics/basal.
#include <algorithm>

#include "config/table_declaration.hpp"
#include "physics/basal/laws.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

// `"a"`, `"a" or "b"`, `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& keywords, const std::string& last) {
  std::string text;
  for (std::size_t k = 0; k < keywords.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == keywords.size() ? " " + last + " " : ", ") + quoted(keywords[k]);
  }
  return text;
}

template <class Laws>
std::vector<Keyword> law_keywords() {
  std::vector<Keyword> keywords;
  physics::basal::for_each_law<Laws>([&]<class Law>(physics::basal::OfType<Law>) {
    keywords.push_back({Law::keyword, Law::text});
  });
  return keywords;
}

// Parameter of laws, and the keywords of the laws that use it.
struct LawNumber {
  const physics::basal::Parameter* number;
  std::vector<std::string> laws;
  bool of_all = false;  // of all laws of its kind

  // Rule of the parameter, with the keywords in its text.
  [[nodiscard]] Rule rule() const {
    Rule rule{.key = number->key, .unit = number->unit, .text = number->text, .source = number->source};
    rule.range = {number->low, number->high, number->low_open, number->high_open};
    const std::string mark = "{laws}";
    if (const std::size_t at = rule.text.find(mark); at != std::string::npos) {
      rule.text.replace(at, mark.size(), (laws.size() == 1 ? "the law " : "the laws ") + quoted_list(laws, "and"));
    }
    return rule;
  }
  [[nodiscard]] bool is_of(const std::string& law) const {
    return std::find(laws.begin(), laws.end(), law) != laws.end();
  }
  // `friction is "a" or "b"`.
  [[nodiscard]] std::string chosen(const std::string& key) const { return key + " is " + quoted_list(laws, "or"); }
};

// All parameters of the laws, each once.
template <class Laws>
std::vector<LawNumber> law_numbers() {
  std::vector<LawNumber> numbers;
  physics::basal::for_each_law<Laws>([&]<class Law>(physics::basal::OfType<Law>) {
    for (const physics::basal::Parameter* number : Law::parameters) {
      auto found = std::find_if(numbers.begin(), numbers.end(), [&](const auto& of) { return of.number == number; });
      if (found == numbers.end()) {
        found = numbers.insert(found, {number, {}});
      }
      found->laws.emplace_back(Law::keyword);
    }
  });
  for (LawNumber& number : numbers) {
    number.of_all = number.laws.size() == std::variant_size_v<Laws>;
  }
  return numbers;
}

template <class Section>
Parameter<Section> law_parameter(const LawNumber& of, std::string GroundStrength::*law_key,
                                 const std::string& key_of_law) {
  auto parameter = Parameter<Section>::bind(
      [number = of.number](Section& section) -> double& { return section.numbers[*number]; }, of.rule());
  if (of.number->only_with_its_laws) {
    parameter.meaning = {"when " + of.chosen(key_of_law), key_of_law,
                         [of, law_key](const Case&, const Section& section) { return of.is_of(section.*law_key); }};
  }
  const bool is_cohesion = law_key == &GroundStrength::cohesion_law;
  return std::move(parameter).usually({of.number->usual_low, of.number->usual_high, of.number->usual_where},
                                      [of, law_key, is_cohesion](const Case& whole, const Section& section) {
                                        const std::string law = of.number->usual_law;
                                        const bool has_effect =
                                            !is_cohesion || section.numbers(physics::basal::initial_cohesion) > 0.0;
                                        return has_band_columns(whole) && has_effect && of.is_of(section.*law_key) &&
                                               (law.empty() || law == section.*law_key);
                                      });
}

// Friction of one kind of ground; `prefix`: of its keys in messages, "basal." or empty.
template <class Section>
Parameters<Section> friction_parameters(const std::string& prefix) {
  Parameters<Section> result{
      Parameter<Section>::bind(&GroundStrength::friction, {.key = "friction",
                                                           .text = "law of basal friction, with the coefficient mu_e",
                                                           .source = "Lei et al., Eqs. 17, 25",
                                                           .keywords = law_keywords<physics::basal::FrictionLaw>()})};
  for (const LawNumber& of : law_numbers<physics::basal::FrictionLaw>()) {
    auto parameter = law_parameter<Section>(of, &GroundStrength::friction, "friction");
    if (of.number->is_needed) {
      parameter.requirement = {"when there is a terrain" + (of.of_all ? "" : " and " + of.chosen(prefix + "friction")),
                               "friction", [of](const Case& whole, const Section& section) {
                                 return whole.terrain.kind != TerrainKind::none && whole.mechanics.enabled &&
                                        of.is_of(section.friction);
                               }};
    }
    result.push_back(std::move(parameter));
  }
  return result;
}

// Cohesion of one kind of ground.
template <class Section>
Parameters<Section> cohesion_parameters(const std::string& prefix) {
  Parameters<Section> result, of_some;
  for (const LawNumber& of : law_numbers<physics::basal::CohesionLaw>()) {
    auto parameter = law_parameter<Section>(of, &GroundStrength::cohesion_law, "cohesion_law");
    if (of.number->is_needed) {
      parameter.requirement = {"when " + prefix + "cohesion > 0 and " + of.chosen(prefix + "cohesion_law"),
                               "cohesion_law", [of](const Case& whole, const Section& section) {
                                 return whole.terrain.kind != TerrainKind::none && of.is_of(section.cohesion_law) &&
                                        section.numbers(physics::basal::initial_cohesion) > 0.0;
                               }};
    }
    (of.of_all ? result : of_some).push_back(std::move(parameter));
  }
  result.push_back(Parameter<Section>::bind(&GroundStrength::cohesion_law,
                                            {.key = "cohesion_law",
                                             .text = "law of the loss of the basal cohesion c_S",
                                             .keywords = law_keywords<physics::basal::CohesionLaw>()}));
  for (auto& parameter : of_some) {
    result.push_back(std::move(parameter));
  }
  return result;
}

void declare_substrate(Tables& tables) {
  const Condition<Substrate> strip{"when neither outline nor raster is given", "outline",
                                   [](const Case&, const Substrate& substrate) { return substrate.is_strip(); }};
  const Condition<Substrate> outline{"when outline is given", "outline", [](const Case&, const Substrate& substrate) {
                                       return !substrate.outline.empty();
                                     }};
  const Condition<Substrate> raster{"when raster is given", "raster",
                                    [](const Case&, const Substrate& substrate) { return !substrate.raster.empty(); }};
  declare(
      tables, "substrate",
      "Part of the terrain with a name of your choice; its friction and cohesion replace those of [basal]",
      &Case::substrates,
      joined<Substrate>(
          {{parameter(&Substrate::x_min, "x_min", "m", {}, "x coordinate of the start of the substrate")
                .otherwise("start of the terrain")
                .only_if(strip),
            parameter(&Substrate::x_max, "x_max", "m", {}, "x coordinate of the end of the substrate")
                .otherwise("end of the terrain")
                .only_if(strip),
            parameter(&Substrate::outline, "outline",
                      "file of the polygons that the substrate covers: Shapefile, GeoPackage or GeoJSON",
                      {.dimension = 3, .is_path = true})
                .otherwise("area specified by raster, or by x_min and x_max"),
            parameter(&Substrate::polygons, "polygons",
                      "names of the polygons that the substrate covers; []: all polygons of the file")
                .only_if(outline),
            parameter(&Substrate::name_attribute, "name_attribute", "attribute that contains the names of the polygons")
                .only_if(outline),
            parameter(
                &Substrate::raster, "raster",
                "raster of substrate codes, which are whole numbers: the substrate covers the cells around the points "
                "with its code",
                {.dimension = 3, .is_path = true})
                .otherwise("area specified by outline, or by x_min and x_max"),
            parameter(&Substrate::code, "code", "code of the substrate in the raster")
                .required_if(raster)
                .only_if(raster)},
           friction_parameters<Substrate>(""),
           cohesion_parameters<Substrate>("")}));
}

void declare_bed(Tables& tables) {
  const Condition<Bed> erodible{"when bed.law is not \"none\"", "law",
                                [](const Case&, const Bed& bed) { return bed.law != BedLaw::none; }};
  const Condition<Bed> outline{
      "when bed.law is not \"none\" and outline is given", "outline",
      [](const Case&, const Bed& bed) { return bed.law != BedLaw::none && !bed.outline.empty(); }};
  declare(
      tables, "bed", "Erodible bed of ice or debris on the terrain", &Case::bed,
      joined<Bed>(
          {{parameter(&Bed::law, "law", "law of entrainment", {.source = "Iverson (2012); Iverson and Ouyang (2015)"})},
           only_if(
               erodible,
               {parameter(&Bed::depth, "depth", "m", at_least(0),
                          "vertical depth of the bed, at most grid.cell; an attribute is that of the polygons of "
                          "bed.outline; the terrain is not lowered where the bed is entrained")
                    .required_if(erodible),
                parameter(&Bed::strength, "strength", "Pa", at_least(0), "shear strength c_b of the bed without load",
                          {.source = "Iverson (2012)"})
                    .required_if(erodible),
                parameter(&Bed::friction_angle, "friction_angle", "degrees", {.low = 0, .high = 90, .high_open = true},
                          "friction angle of the bed, which adds strength under load"),
                parameter(&Bed::depth_per_slip, "depth_per_slip", "", above(0),
                          "entrained depth per slip [m/m] if the bed yields; with the law \"momentum\", its maximum")
                    .required_if(erodible),
                parameter(&Bed::outline, "outline",
                          "file of the polygons that the bed covers: Shapefile, GeoPackage or GeoJSON",
                          {.dimension = 3, .is_path = true})
                    .otherwise("the bed covers the domain")}),
           only_if(outline, {parameter(&Bed::polygons, "polygons",
                                       "names of the polygons that the bed covers; []: all polygons of the file"),
                             parameter(&Bed::name_attribute, "name_attribute",
                                       "attribute that contains the names of the polygons")}),
           only_if(erodible,
                   {parameter(&Bed::material, "material", "name of the bed's material").required_if(erodible),
                    parameter(&Bed::temperature, "temperature", "C", {.low = -273.15, .high = 100, .low_open = true},
                              "temperature of the bed; ice and water follow from the freezing curve"),
                    parameter(
                        &Bed::porosity, "porosity", "", {.low = 0, .high = physics::largest_porosity, .low_open = true},
                        "porosity n of the bed: volume fraction of ice and water", {.source = "Lei et al., Eq. 1"}),
                    parameter(&Bed::particles_per_axis, "particles_per_axis", "", between(1, 16),
                              "number of particles of entrained material per cell along each axis")})}));
}

void declare_contact(Tables& tables) {
  const char* const friction_text = "friction angle between bodies that are in contact";
  const Range friction_range{.low = 0, .high = 90, .high_open = true};
  const auto frictional =
      if_is(&Contact::between_bodies, BodyContact::frictional, "contact.between_bodies", "between_bodies");
  const auto pair = if_is(&ContactPair::contact, BodyContact::frictional, "the pair's contact", "contact");
  declare(tables, "contact", "Contact between bodies", &Case::contact,
          {parameter(&Contact::between_bodies, "between_bodies", "contact between bodies without a [contact_pair.NAME]",
                     {.source = "Bardenhagen et al. (2000); Nairn (2013)"}),
           parameter(&Contact::friction_angle, "friction_angle", "degrees", friction_range, friction_text)
               .required_if(frictional)
               .only_if(frictional)});
  declare(tables, "contact_pair", "Contact between two bodies, with a name of your choice", &Case::contact_pairs,
          {parameter(&ContactPair::bodies, "bodies", "names of the two bodies").required(),
           parameter(&ContactPair::contact, "contact", "contact between the two bodies").required(),
           parameter(&ContactPair::friction_angle, "friction_angle", "degrees", friction_range, friction_text)
               .required_if(pair)
               .only_if(pair)});
}

}  // namespace

void declare_basal(Tables& tables) {
  declare(
      tables, "basal", "Friction and cohesion at the base", &Case::basal,
      joined<Basal>(
          {friction_parameters<Basal>("basal."),
           {parameter(&Basal::clamp, "clamp",
                      "basal strength S_slide if the pore pressure P exceeds the normal stress N",
                      {.source = "Lei et al., Eq. 17"}),
            parameter(&Basal::cap_pressure, "cap_pressure",
                      "true: the pore pressure P in the friction law is limited to the normal stress N",
                      {.source = "Lei et al., Eq. 17"}),
            parameter(&Basal::heat_fraction, "heat_fraction", "", between(0, 1),
                      "energy conversion coefficient: fraction of the friction work that heats the sliding mass",
                      {.source = "Lei et al., Eq. 20, Secs. 3.3, 4"})
                .usually({0.8, 1}, [](const Case& whole, const Basal&) { return has_band_columns(whole); }),
            parameter(
                &Basal::distance_check, "distance_check",
                "true: contact begins when the edges of particles reach the terrain; false: it begins when the sliding "
                "mass approaches nodes, up to one cell early",
                {.source = "Nairn (2013)"})},
           cohesion_parameters<Basal>("basal.")}));
  declare_substrate(tables);
  declare_bed(tables);
  declare_contact(tables);
}

}  // namespace thawslide::config
