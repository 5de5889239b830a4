// Parameters of the base: [basal], [substrate.NAME]. Keywords and parameters of the laws are defined in physics/basal.
#include <algorithm>

#include "config/table_declaration.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

namespace {

using FrictionLaws = physics::basal::FrictionLaw;
using CohesionLaws = physics::basal::CohesionLaw;

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
  [[nodiscard]] Rule rule() const;
  [[nodiscard]] bool is_of(const std::string& law) const {
    return std::find(laws.begin(), laws.end(), law) != laws.end();
  }
  // `friction is "a" or "b"`.
  [[nodiscard]] std::string chosen(const std::string& key) const;
};

Rule LawNumber::rule() const {
  Rule rule{.key = number->key, .unit = number->unit, .text = number->text, .source = number->source};
  rule.range = {number->low, number->high, number->low_open, number->high_open};
  const std::string mark = "{laws}";
  const std::size_t at = rule.text.find(mark);
  if (at != std::string::npos) {
    rule.text.replace(at, mark.size(), (laws.size() == 1 ? "the law " : "the laws ") + quoted_list(laws, "and"));
  }
  return rule;
}

std::string LawNumber::chosen(const std::string& key) const { return key + " is " + quoted_list(laws, "or"); }

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
    parameter = std::move(parameter).only_if(
        "when " + of.chosen(key_of_law), key_of_law,
        [of, law_key](const Case&, const Section& section) { return of.is_of(section.*law_key); });
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
std::vector<Parameter<Section>> friction_parameters(const std::string& prefix) {
  std::vector<Parameter<Section>> result{
      Parameter<Section>::bind(&GroundStrength::friction, {.key = "friction",
                                                           .text = "law of basal friction, with the coefficient mu_e",
                                                           .source = "Lei et al., Eqs. 17, 25",
                                                           .keywords = law_keywords<FrictionLaws>()})};
  for (const LawNumber& of : law_numbers<FrictionLaws>()) {
    auto parameter = law_parameter<Section>(of, &GroundStrength::friction, "friction");
    if (of.number->is_needed) {
      parameter = std::move(parameter).required_if(
          "when there is a terrain" + (of.of_all ? "" : " and " + of.chosen(prefix + "friction")),
          [of](const Case& whole, const Section& section) {
            return whole.terrain.kind != TerrainKind::none && whole.mechanics.enabled && of.is_of(section.friction);
          });
    }
    result.push_back(std::move(parameter));
  }
  return result;
}

// Cohesion of one kind of ground.
template <class Section>
std::vector<Parameter<Section>> cohesion_parameters(const std::string& prefix) {
  std::vector<Parameter<Section>> result, of_some;
  for (const LawNumber& of : law_numbers<CohesionLaws>()) {
    auto parameter = law_parameter<Section>(of, &GroundStrength::cohesion_law, "cohesion_law");
    if (of.number->is_needed) {
      parameter = std::move(parameter).required_if(
          "when " + prefix + "cohesion > 0 and " + of.chosen(prefix + "cohesion_law"),
          [of](const Case& whole, const Section& section) {
            return whole.terrain.kind != TerrainKind::none && of.is_of(section.cohesion_law) &&
                   section.numbers(physics::basal::initial_cohesion) > 0.0;
          });
    }
    (of.of_all ? result : of_some).push_back(std::move(parameter));
  }
  result.push_back(
      Parameter<Section>::bind(&GroundStrength::cohesion_law, {.key = "cohesion_law",
                                                               .text = "law of the loss of the basal cohesion c_S",
                                                               .keywords = law_keywords<CohesionLaws>()}));
  for (auto& parameter : of_some) {
    result.push_back(std::move(parameter));
  }
  return result;
}

std::vector<Parameter<Basal>> strength_parameters() {
  return {
      parameter(&Basal::clamp, {.key = "clamp",
                                .text = "basal strength S_slide if the pore pressure P exceeds the normal stress N",
                                .source = "Lei et al., Eq. 17"}),
      parameter(&Basal::cap_pressure,
                {.key = "cap_pressure",
                 .text = "true: the pore pressure P in the friction law is limited to the normal stress N",
                 .source = "Lei et al., Eq. 17"}),
      parameter(&Basal::heat_fraction,
                {.key = "heat_fraction",
                 .range = between(0, 1),
                 .text = "energy conversion coefficient: fraction of the friction work that heats the sliding mass",
                 .source = "Lei et al., Eq. 20, Secs. 3.3, 4"})
          .usually({0.8, 1}, [](const Case& whole, const Basal&) { return has_band_columns(whole); }),
      parameter(&Basal::distance_check,
                {.key = "distance_check",
                 .text = "true: contact begins when the edges of particles reach the terrain; false: it begins when "
                         "the sliding mass approaches nodes, up to one cell early",
                 .source = "Nairn (2013)"}),
  };
}

std::vector<Parameter<Basal>> basal_parameters() {
  std::vector<Parameter<Basal>> result = friction_parameters<Basal>("basal.");
  for (const auto& more : {strength_parameters(), cohesion_parameters<Basal>("basal.")}) {
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

std::vector<Parameter<Substrate>> area_parameters() {
  const auto is_strip = [](const Case&, const Substrate& substrate) { return substrate.is_strip(); };
  const auto has_outline = [](const Case&, const Substrate& substrate) { return !substrate.outline.empty(); };
  const auto has_raster = [](const Case&, const Substrate& substrate) { return !substrate.raster.empty(); };
  const std::string when_strip = "when neither outline nor raster is given";
  const std::string when_outline = "when outline is given", when_raster = "when raster is given";
  return {
      parameter(&Substrate::x_min, {.key = "x_min", .unit = "m", .text = "x coordinate of the start of the substrate"})
          .otherwise("start of the terrain")
          .only_if(when_strip, "outline", is_strip),
      parameter(&Substrate::x_max, {.key = "x_max", .unit = "m", .text = "x coordinate of the end of the substrate"})
          .otherwise("end of the terrain")
          .only_if(when_strip, "outline", is_strip),
      parameter(&Substrate::outline,
                {.key = "outline",
                 .text = "file of the polygons that the substrate covers: Shapefile, GeoPackage or GeoJSON",
                 .dimension = 3,
                 .is_path = true})
          .otherwise("area specified by raster, or by x_min and x_max"),
      parameter(
          &Substrate::polygons,
          {.key = "polygons", .text = "names of the polygons that the substrate covers; []: all polygons of the file"})
          .only_if(when_outline, "outline", has_outline),
      parameter(&Substrate::name_attribute,
                {.key = "name_attribute", .text = "attribute that contains the names of the polygons"})
          .only_if(when_outline, "outline", has_outline),
      parameter(&Substrate::raster, {.key = "raster",
                                     .text = "raster of substrate codes, which are whole numbers: the substrate covers "
                                             "the cells around the points with its code",
                                     .dimension = 3,
                                     .is_path = true})
          .otherwise("area specified by outline, or by x_min and x_max"),
      parameter(&Substrate::code, {.key = "code", .text = "code of the substrate in the raster"})
          .required_if(when_raster, has_raster)
          .only_if(when_raster, "raster", has_raster),
  };
}

std::vector<Parameter<Substrate>> substrate_parameters() {
  std::vector<Parameter<Substrate>> result = area_parameters();
  for (const auto& more : {friction_parameters<Substrate>(""), cohesion_parameters<Substrate>("")}) {
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

}  // namespace

void declare_basal(Tables& tables) {
  tables.push_back(std::make_unique<SingleTable<Basal>>("basal", "Friction and cohesion at the base", &Case::basal,
                                                        basal_parameters()));
  tables.push_back(std::make_unique<NamedTable<Substrate>>(
      "substrate", "Part of the terrain with a name of your choice; its friction and cohesion replace those of [basal]",
      &Case::substrates, substrate_parameters()));
}

}  // namespace thawslide::config
