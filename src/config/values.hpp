// Form of each type of the Case in a case file: reading, writing, description, editor schema.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "config/case.hpp"
#include "config/keywords.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

// Context for writing a value.
struct WriteContext {
  int dimension = 2;
  std::filesystem::path input_folder;  // if not empty, paths consist of this folder and the file's name
};

// Has type (text), read (reports problems; returns if the node is valid), write (TOML), schema (JSON), and keywords.
template <class T>
struct Value;

// Default of most types: no keywords.
struct ValueWithoutKeywords {
  static std::vector<Keyword> keywords() { return {}; }
};

#define THAWSLIDE_DECLARE_VALUE(Type)                                              \
  template <>                                                                      \
  struct Value<Type> : ValueWithoutKeywords {                                      \
    static std::string type(const Rule& rule);                                     \
    static bool read(const toml::node& node, const ValueReader& at, Type& value);  \
    static std::string write(const Type& value, const Rule&, const WriteContext&); \
    static nlohmann::json schema(const Rule& rule);                                \
  };

using Vertices = std::vector<std::array<double, 2>>;
using Numbers = std::vector<double>;
using Names = std::vector<std::string>;

THAWSLIDE_DECLARE_VALUE(double)
THAWSLIDE_DECLARE_VALUE(int)
THAWSLIDE_DECLARE_VALUE(bool)
THAWSLIDE_DECLARE_VALUE(std::string)
THAWSLIDE_DECLARE_VALUE(Names)     // texts
THAWSLIDE_DECLARE_VALUE(Point)     // one number per dimension of the case, or x and y
THAWSLIDE_DECLARE_VALUE(Vertices)  // [[x, y], ...]
THAWSLIDE_DECLARE_VALUE(Numbers)   // ascending
THAWSLIDE_DECLARE_VALUE(NumberOrAuto)
THAWSLIDE_DECLARE_VALUE(BandThickness)  // number | { time = [...], value = [...] }
THAWSLIDE_DECLARE_VALUE(WidthOverX)     // number | { x = [...], value = [...] }
// number | { depth = [...], value = [...] } | { x = [...], value = [...] } | { attribute = "..." } | { raster = "..." }
THAWSLIDE_DECLARE_VALUE(InitialField)
THAWSLIDE_DECLARE_VALUE(MapValue)      // number | { attribute = "..." } | { raster = "..." } | { surface = "..." }
THAWSLIDE_DECLARE_VALUE(ReleaseTime)   // number | { attribute = "..." }
THAWSLIDE_DECLARE_VALUE(HeatBoundary)  // "insulated" | { temperature = T } | { flux = q }

#undef THAWSLIDE_DECLARE_VALUE

// Reads a keyword from a list, and suggests the most similar one if it is misspelt.
bool read_keyword(const toml::node& node, const ValueReader& at, const std::vector<Keyword>& keywords,
                  std::string& found);
std::string keyword_list(const std::vector<Keyword>& keywords);
nlohmann::json keyword_schema(const std::vector<Keyword>& keywords);
std::string quoted(const std::string& text);
// Path in the form of the written case.
std::string path_text(const std::string& path, const WriteContext& context);

template <class Enum>
requires std::is_enum_v<Enum>
struct Value<Enum> {
  static std::vector<Keyword> keywords() {
    std::vector<Keyword> keywords;
    for (const Choice<Enum>& choice : choices(Enum{})) {
      keywords.push_back({choice.keyword, choice.text});
    }
    return keywords;
  }
  static std::string type(const Rule&) { return "one of " + keyword_list(keywords()); }
  static bool read(const toml::node& node, const ValueReader& at, Enum& value) {
    std::string found;
    if (!read_keyword(node, at, keywords(), found)) {
      return false;
    }
    for (const Choice<Enum>& choice : choices(Enum{})) {
      value = choice.keyword == found ? choice.value : value;
    }
    return true;
  }
  static std::string write(const Enum& value, const Rule&, const WriteContext&) {
    for (const Choice<Enum>& choice : choices(Enum{})) {
      if (choice.value == value) {
        return quoted(choice.keyword);
      }
    }
    return quoted("");
  }
  static nlohmann::json schema(const Rule&) { return keyword_schema(keywords()); }
};

}  // namespace thawslide::config
