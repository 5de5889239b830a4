// Reading of the map files of a case, and its warnings and notes, other than results and errors.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "run/observer.hpp"
#include "sim/checks/body_figures.hpp"

namespace thawslide::run {

// "warning: " and the text. Information, which needs no action, begins with "note: " instead.
[[nodiscard]] std::string warning_line(const std::string& text);

class Warnings {
 public:
  // observer: reports each warning at once; null: they are only kept.
  explicit Warnings(Observer* observer = nullptr) : observer_(observer) {}

  // Ignores an empty text.
  void add(const std::string& text);
  void add(const std::vector<std::string>& texts);

  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  Observer* observer_;
  std::vector<std::string> all_;
};

// Requires a simulation before its first step.
template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings);

// Contents of the map files; empty for a case without any. Throws UserError for a build without GDAL.
config::Site read_map_files(const config::Case& parameters, Warnings& warnings);

}  // namespace thawslide::run
