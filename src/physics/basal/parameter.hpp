// Declaration of a basal law (Eq. 17) and its parameters in the case file. A law is a struct in a separate header, with
// one line in laws.hpp. It has
//   keyword, text       keyword in the case file, and description
//   depends_on_mass     whether it reads temperature, saturation, solid fraction or slip of the node
//   parameters          its numbers, declared there or shared with other laws (shared_parameters.hpp)
//   from(numbers)       creates the law from a function that returns the number of a parameter
//   coefficient(node)   friction law: mu_e; depends_on_pore_pressure: applied to N - P; optional drag(node):
//                       part independent of N [Pa]
//   cohesion(node)      cohesion law: c_S [Pa]
#pragma once

#include <array>
#include <limits>

namespace thawslide::physics::basal {

// Number of the case file, with its documentation.
struct Parameter {
  const char* key;
  const char* unit = "";
  double initial = 0.0;             // default
  bool is_needed = false;           // no default: required if one of its laws is selected
  bool only_with_its_laws = false;  // not allowed if none of its laws is selected
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  double usual_low = -std::numeric_limits<double>::infinity();  // typical range with band columns, an assumption
  double usual_high = std::numeric_limits<double>::infinity();
  const char* usual_where = "";  // "for ice bonds"
  const char* usual_law = "";    // keyword of the only law to which the typical range applies; empty: all
  const char* text = "";  // "{laws}" in it is replaced by the law "x", or the laws "x" and "y", that use the number
  const char* source = "";
};

template <class... P>
constexpr std::array<const Parameter*, sizeof...(P)> parameter_list(const P&... parameters) {
  return {&parameters...};
}

}  // namespace thawslide::physics::basal
