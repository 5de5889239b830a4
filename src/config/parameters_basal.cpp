// Parameters of the base: [basal], [substrate.NAME]. Keywords and parameters of the laws are defined in physics/basal.
#include <algorithm>

#include "config/table_declaration.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

namespace {

using FrictionLaws = physics::basal::FrictionLaw;
using CohesionLaws = physics::basal::CohesionLaw;

// `"a"`, `"a" or "b"`, `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == words.size() ? " " + last + " " : ", ") + quoted(words[k]);
  }
  return text;
}

template <class Laws>
std::vector<Keyword> law_keywords() {
  std::vector<Keyword> words;
  physics::basal::for_each_law<Laws>([&]<class Law>(physics::basal::OfType<Law>) {
    words.push_back({Law::word, Law::text});
  });
  return words;
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
      found->laws.emplace_back(Law::word);
    }
  });
  for (LawNumber& number : numbers) {
    number.of_all = number.laws.size() == std::variant_size_v<Laws>;
  }
  return numbers;
}

template <class Section>
Parameter<Section> law_parameter(const LawNumber& of, std::string GroundStrength::*word, const std::string& word_key) {
  auto parameter = Parameter<Section>::bind(
      [number = of.number](Section& section) -> double& { return section.numbers[*number]; }, of.rule());
  if (of.number->only_with_its_laws) {
    parameter = std::move(parameter).only_if(
        "when " + of.chosen(word_key), word_key,
        [of, word](const Case&, const Section& section) { return of.is_of(section.*word); });
  }
  const bool is_cohesion = word == &GroundStrength::cohesion_law;
  return std::move(parameter).usually(
      {of.number->usual_low, of.number->usual_high, of.number->usual_where},
      [of, word, is_cohesion](const Case& whole, const Section& section) {
        const std::string law = of.number->usual_law;
        const bool is_felt = !is_cohesion || section.numbers(physics::basal::initial_cohesion) > 0.0;
        return has_band_columns(whole) && is_felt && of.is_of(section.*word) && (law.empty() || law == section.*word);
      });
}

// Friction of one kind of ground; `prefix`: of its keys in messages, "basal." or empty.
template <class Section>
std::vector<Parameter<Section>> friction_parameters(const std::string& prefix) {
  std::vector<Parameter<Section>> result{
      Parameter<Section>::bind(&GroundStrength::friction, {.key = "friction",
                                                           .text = "law of the friction coefficient mu_e",
                                                           .source = "Eqs. 17, 25",
                                                           .words = law_keywords<FrictionLaws>()})};
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
                                                               .text = "how the cohesion c_S along the ground is lost",
                                                               .words = law_keywords<CohesionLaws>()}));
  for (auto& parameter : of_some) {
    result.push_back(std::move(parameter));
  }
  return result;
}

std::vector<Parameter<Basal>> strength_parameters() {
  return {
      parameter(&Basal::clamp,
                {.key = "clamp",
                 .text = "strength S_slide of the ground where the pore pressure P passes the normal stress N",
                 .source = "Eq. 17"}),
      parameter(&Basal::cap_pressure, {.key = "cap_pressure",
                                       .text = "the pore pressure P counts as N, the normal stress, at most",
                                       .source = "Eq. 17"}),
      parameter(&Basal::heat_fraction,
                {.key = "heat_fraction",
                 .range = between(0, 1),
                 .text = "energy conversion coefficient: share of the friction work that heats the slide",
                 .source = "Eq. 20, Secs. 3.3, 4"})
          .usually({0.8, 1}, [](const Case& whole, const Basal&) { return has_band_columns(whole); }),
      parameter(&Basal::distance_check, {.key = "distance_check",
                                         .text = "contact waits until the particles' own edges reach the ground; off: "
                                                 "it acts as soon as the slide approaches nodes, up to a cell early",
                                         .source = "Nairn 2013"}),
  };
}

std::vector<Parameter<Basal>> basal_parameters() {
  std::vector<Parameter<Basal>> result = friction_parameters<Basal>("basal.");
  for (const auto& more : {strength_parameters(), cohesion_parameters<Basal>("basal.")}) {
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

std::vector<Parameter<Substrate>> place_parameters() {
  const auto is_strip = [](const Case&, const Substrate& substrate) { return substrate.is_strip(); };
  const auto has_outline = [](const Case&, const Substrate& substrate) { return !substrate.outline.empty(); };
  const auto has_raster = [](const Case&, const Substrate& substrate) { return !substrate.raster.empty(); };
  const std::string when_strip = "when neither outline nor raster is given";
  const std::string when_outline = "when outline is given", when_raster = "when raster is given";
  return {
      parameter(&Substrate::x_min, {.key = "x_min", .unit = "m", .text = "where along x the substrate begins"})
          .otherwise("it begins where the ground does")
          .only_if(when_strip, "outline", is_strip),
      parameter(&Substrate::x_max, {.key = "x_max", .unit = "m", .text = "where along x the substrate ends"})
          .otherwise("it ends where the ground does")
          .only_if(when_strip, "outline", is_strip),
      parameter(&Substrate::outline,
                {.key = "outline",
                 .text = "file of polygons in which the substrate lies: Shapefile, GeoPackage or GeoJSON",
                 .dimension = 3,
                 .is_path = true})
          .otherwise("raster, or x_min and x_max, say where"),
      parameter(&Substrate::polygons,
                {.key = "polygons", .text = "names of the polygons in which it lies; []: all of the file"})
          .only_if(when_outline, "outline", has_outline),
      parameter(&Substrate::name_attribute,
                {.key = "name_attribute", .text = "attribute that holds the polygons' names"})
          .only_if(when_outline, "outline", has_outline),
      parameter(&Substrate::raster, {.key = "raster",
                                     .text = "raster of whole numbers, each the code of a substrate: it lies in the "
                                             "cells about the points that hold its own",
                                     .dimension = 3,
                                     .is_path = true})
          .otherwise("outline, or x_min and x_max, say where"),
      parameter(&Substrate::code, {.key = "code", .text = "the substrate's code in the raster"})
          .required_if(when_raster, has_raster)
          .only_if(when_raster, "raster", has_raster),
  };
}

std::vector<Parameter<Substrate>> substrate_parameters() {
  std::vector<Parameter<Substrate>> result = place_parameters();
  for (const auto& more : {friction_parameters<Substrate>(""), cohesion_parameters<Substrate>("")}) {
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

}  // namespace

void declare_basal(Tables& tables) {
  tables.push_back(std::make_unique<SingleTable<Basal>>("basal", "Friction and cohesion along the ground", &Case::basal,
                                                        basal_parameters()));
  tables.push_back(std::make_unique<NamedTable<Substrate>>(
      "substrate", "Part of the ground with friction and cohesion of its own, in place of those of [basal]",
      &Case::substrates, substrate_parameters()));
}

}  // namespace thawslide::config
