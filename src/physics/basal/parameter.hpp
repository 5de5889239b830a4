// How a law of the base (Eq. 17) says what it takes from the case file. A law is a struct in a header of its own, and
// one line in laws.hpp. It has
//   word, text          what the case file calls it, and what it does
//   parameters          the numbers that it takes, declared here or shared with others (shared_parameters.hpp)
//   from(numbers)       the law, from a function that gives the number of a parameter
//   coefficient(node)   of a friction law: mu_e; depends_on_pore_pressure: of N - P; drag(node), if any: no share of N
//   [Pa] cohesion(node)      of a cohesion law: c_S [Pa]
#pragma once

#include <array>
#include <limits>

namespace thawslide::physics::basal {

// A number of the case file, and all that is said of it there.
struct Parameter {
  const char* key;
  const char* unit = "";
  double initial = 0.0;             // default
  bool is_needed = false;           // no default: where one of its laws is chosen it must be given
  bool only_with_its_laws = false;  // where none of these is chosen it must not be given
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  double usual_low = -std::numeric_limits<double>::infinity();  // of a base with band columns, not checked
  double usual_high = std::numeric_limits<double>::infinity();
  const char* usual_where = "";  // "on a glacier"
  const char* usual_law = "";    // word of the only law that these are usual of; empty: of any
  const char* text = "";         // "{laws}" in it: the law "x", or the laws "x" and "y", that take the number
  const char* source = "";
};

template <class... P>
constexpr std::array<const Parameter*, sizeof...(P)> parameter_list(const P&... parameters) {
  return {&parameters...};
}

}  // namespace thawslide::physics::basal
