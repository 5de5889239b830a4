// Checks of contact between bodies.
#include <fmt/format.h>

#include <set>

#include "config/body_layers.hpp"
#include "config/checks.hpp"

namespace thawslide::config {

namespace {

constexpr std::size_t most_layers = 15;           // limit of mpm::Tile
constexpr std::size_t most_layers_in_stages = 7;  // held bodies have separate layers

// Checks that each pair names two existing bodies, and that no two pairs name the same bodies.
bool check_names(const Case& checked, Reading& reading) {
  std::set<std::set<std::string>> seen;
  bool are_right = true;
  for (const auto& [name, pair] : checked.contact_pairs) {
    const std::string key = "contact_pair." + name + ".bodies";
    if (!reading.are_valid({key})) {
      are_right = false;
      continue;
    }
    const std::set<std::string> names(pair.bodies.begin(), pair.bodies.end());
    if (pair.bodies.size() != 2 || names.size() != 2) {
      reading.report(key,
                     fmt::format("{} has {} names of {} bodies; allowed: the names of two. Name the two bodies, as "
                                 "in bodies = [\"ice\", \"rock\"].",
                                 key, pair.bodies.size(), names.size()));
      are_right = false;
      continue;
    }
    for (const std::string& body : pair.bodies) {
      if (checked.bodies.count(body) == 0) {
        std::vector<std::string> known;
        for (const auto& [known_body, unused] : checked.bodies) {
          known.push_back(known_body);
        }
        const std::string hint = did_you_mean(body, known);
        reading.report(key, fmt::format("{} names '{}', and there is no [body.{}]{} Allowed: {}.", key, body, body,
                                        hint.empty() ? "." : hint, comma_list(known)));
        are_right = false;
      }
    }
    if (are_right && !seen.insert(names).second) {
      reading.report(key,
                     fmt::format("{} names two bodies that another [contact_pair.NAME] names too. Remove one.", key));
      are_right = false;
    }
  }
  return are_right;
}

}  // namespace

void check_contact(const Case& checked, Reading& reading) {
  if (checked.bodies.empty() || !check_names(checked, reading) || !reading.are_valid({"contact.between_bodies"})) {
    return;
  }
  for (const auto& [name, pair] : checked.contact_pairs) {
    if (!reading.are_valid({"contact_pair." + name + ".contact", "contact_pair." + name + ".friction_angle"})) {
      return;
    }
  }
  std::string contradiction, of_pair;
  const BodyLayers layers = body_layers(checked, &contradiction, &of_pair);
  if (!contradiction.empty()) {
    reading.report("contact_pair." + of_pair + ".contact", contradiction);
    return;
  }
  const std::string key =
      checked.contact.between_bodies == BodyContact::frictional ? "contact.between_bodies" : "contact_pair";
  const bool is_staged = has_stages(checked);
  const std::size_t most = is_staged ? most_layers_in_stages : most_layers;
  if (layers.count > most) {
    reading.report_misfit(
        {key},
        fmt::format("{}: too many bodies, or groups of bonded ones, in frictional contact (found {}; allowed {}{}). "
                    "Bond those that move as one by [contact_pair.NAME] with contact = "
                    "\"bonded\".",
                    key, layers.count, most, is_staged ? " with a body.NAME.release_time" : ""));
  }
  if (layers.count > 1 && reading.are_valid({"band.model"}) && has_band_columns(checked)) {
    reading.report_misfit({key, "band.model"},
                          fmt::format("{}: frictional contact between bodies and band.model = \"columns\" exclude each "
                                      "other. Set contact.between_bodies = \"bonded\", or band.model = "
                                      "\"scaled\".",
                                      key));
  }
  if (layers.count > 1 && reading.are_valid({"bed.law"}) && checked.bed.law != BedLaw::none) {
    reading.report_misfit(
        {key, "bed.law"},
        fmt::format("{}: frictional contact between bodies and an erodible bed (bed.law) exclude each "
                    "other. Set contact.between_bodies = \"bonded\", or remove [bed].",
                    key));
  }
}

}  // namespace thawslide::config
