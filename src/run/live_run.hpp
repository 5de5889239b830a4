// Simulation of a case in memory, advanced by its caller: the same steps and history rows as a run in a folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "run/observer.hpp"
#include "sim/records/history.hpp"
#include "terrain/basal_law.hpp"

namespace thawslide::run {

// Memory of a particle field in blocks of `lanes` particles, components after each other. `owner` keeps it alive; its
// content is that of the field until the next step, change or restoration.
struct FieldMemory {
  std::shared_ptr<const void> owner;
  const void* data;
  std::size_t particles, blocks, components, lanes;
  bool is_integer;    // otherwise double
  std::size_t bytes;  // of a number
  bool may_move;      // by a step, because particles may join: the memory must be copied before
};

// Nodes with mass in the last step: position [m], mass [kg], velocity at its start [m/s]; rows of `dimension` numbers.
struct NodeTable {
  std::size_t dimension;
  std::vector<double> position, mass, velocity;
};

struct FieldDescription {
  std::string name, unit, text;
  std::size_t components;
};

class LiveRun {
 public:
  virtual ~LiveRun() = default;
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  [[nodiscard]] virtual const config::Case& parameters() const = 0;
  [[nodiscard]] virtual double time() const = 0;  // simulated [s]
  [[nodiscard]] virtual std::int64_t step_number() const = 0;
  [[nodiscard]] virtual std::size_t particle_count() const = 0;
  // True if no step is left: the end or rest is reached, or the whole slide has left the domain (end_text).
  [[nodiscard]] virtual bool is_done() const = 0;
  [[nodiscard]] virtual std::string end_text() const = 0;
  // Lower corner of the domain [m], to which positions are relative.
  [[nodiscard]] virtual std::vector<double> origin() const = 0;

  // Performs the next step, if any, and adds a history row if one is due. Throws RunError. strength: null or basal law.
  virtual void step(const terrain::StrengthLaw* strength) = 0;
  // True if steps evaluate basal laws: the case has a terrain and mechanics.
  [[nodiscard]] virtual bool has_basal_law() const = 0;
  // Rows so far, beginning with the state at t = 0; names are those of history.csv.
  [[nodiscard]] virtual const std::vector<sim::HistoryRow>& history() const = 0;

  // Row of the present state.
  [[nodiscard]] virtual sim::HistoryRow row() const = 0;
  // State and results so far, with the names of run.json.
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> key_numbers() const = 0;
  // The maps, none in 2D; and a map of the state so far. Throws UserError for an unknown name.
  [[nodiscard]] virtual std::vector<FieldDescription> maps() const = 0;
  [[nodiscard]] virtual Raster map(const std::string& name) const = 0;
  [[nodiscard]] virtual NodeTable nodes() const = 0;

  [[nodiscard]] virtual std::vector<FieldDescription> fields() const = 0;
  // Throws UserError for an unknown name.
  [[nodiscard]] virtual FieldMemory field(const std::string& name) = 0;

  // State with the history, and its restoration in a live run of the same case. Both throw UserError.
  [[nodiscard]] virtual std::string checkpoint() const = 0;
  virtual void restore(const std::string& checkpoint) = 0;

  // Continues with a case that differs in keys that may change on resume; `sets`: the changes. Throws UserError.
  virtual void change(const config::Case& next, const std::vector<std::string>& sets) = 0;

 protected:
  LiveRun() = default;
};

// Reads and sets up a case, and settles its particles. device: "cpu", "gpu" or "auto". Throws UserError, RunError and
// DeviceError. The observer receives the warnings and must outlive the live run.
[[nodiscard]] std::unique_ptr<LiveRun> make_live_run(const config::Case& parameters, const std::string& device,
                                                     Observer& observer);

}  // namespace thawslide::run
