#include "run/live_run.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "base/error.hpp"
#include "config/case_changes.hpp"
#include "config/describe.hpp"
#include "config/notices.hpp"
#include "io/checkpoint.hpp"
#include "run/resume_checks.hpp"
#include "run/run_cost.hpp"
#include "run/run_loop.hpp"
#include "run/run_output.hpp"
#include "run/setup.hpp"
#include "run/step_warnings.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/run_records.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::run {

namespace {

template <int Dim>
class LiveRunOf final : public LiveRun {
 public:
  using Simulation = sim::Simulation<Dim>;

  LiveRunOf(const config::Case& parameters, const config::Site& site, std::string device, Warnings& warnings,
            Observer& observer)
      : observer_(observer),
        device_(std::move(device)),
        simulation_(std::make_shared<Simulation>(parameters, site)),
        records_(*simulation_, simulation_->site()),
        history_schedule_(history_schedule(parameters.time, 0.0, 0.0)),
        snapshot_schedule_(snapshot_schedule(parameters.time, 0.0, 0.0)),
        warnings_(*simulation_) {
    add_setup_warnings(*simulation_, sim::body_figures(*simulation_), warnings);
    use_device<Dim>(device_, *simulation_);
    if (simulation_->needs_settling()) {
      observer.line("settling under gravity for {:g} s", parameters.mechanics.settle_time);
      if (!simulation_->settle([&] { return observer.interruption().empty(); })) {
        throw UserError("interrupted by {} while the body settled", observer.interruption());
      }
    }
    records_.start(*simulation_);
    add_row();
  }

  [[nodiscard]] const config::Case& parameters() const override { return simulation_->parameters(); }
  [[nodiscard]] double time() const override { return simulation_->time(); }
  [[nodiscard]] std::int64_t step_number() const override { return simulation_->step_number(); }
  [[nodiscard]] std::size_t particle_count() const override { return simulation_->particle_count(); }
  [[nodiscard]] bool is_done() const override {
    return !simulation_->left_text().empty() || simulation_->ends_at_rest() ||
           has_reached_end(simulation_->time(), simulation_->last_step(), parameters().time.end);
  }
  [[nodiscard]] std::string end_text() const override {
    const std::string& left = simulation_->left_text();
    return left.empty() && simulation_->ends_at_rest() ? simulation_->rest_text() : left;
  }
  [[nodiscard]] bool has_basal_law() const override {
    return simulation_->ground() != nullptr && parameters().mechanics.enabled;
  }
  [[nodiscard]] std::vector<double> origin() const override {
    const auto& origin = simulation_->model().origin;
    return {origin.data(), origin.data() + Dim};
  }

  void step(const terrain::StrengthLaw* strength) override {
    require_intact_device();
    if (is_done()) {
      return;
    }
    try {
      simulation_->step(simulation_->next_step(std::min(snapshot_schedule_.next(), parameters().time.end)), strength);
      if (!simulation_->left_text().empty()) {
        records_.slide_left();
        add_row();
        return;
      }
      records_.after_step(*simulation_);
    } catch (const RunError&) {
      add_row();
      throw;
    }
    observer_.texts("", warnings_.after_step(*simulation_));
    const double time = simulation_->time(), dt = simulation_->last_step();
    const bool rests = simulation_->ends_at_rest();
    if (history_schedule_.reached(time, dt) || parameters().time.history_interval <= 0.0 || rests) {
      add_row();
    }
    if (snapshot_schedule_.reached(time, dt) || rests) {
      observer_.texts("", warnings_.after_snapshot(*simulation_));
    }
  }

  [[nodiscard]] const std::vector<sim::HistoryRow>& history() const override { return history_; }

  [[nodiscard]] sim::HistoryRow row() const override { return records_.history_row(*simulation_); }

  [[nodiscard]] std::vector<std::pair<std::string, double>> key_numbers() const override {
    auto numbers = sim::named(sim::end_state(*simulation_, !simulation_->left_text().empty()));
    if (const auto figures = records_.figures(*simulation_, sim::ground_height_of(*simulation_))) {
      const auto of_maps = sim::named(*figures);
      numbers.insert(numbers.end(), of_maps.begin(), of_maps.end());
    }
    return numbers;
  }

  [[nodiscard]] std::vector<FieldDescription> maps() const override {
    std::vector<FieldDescription> all;
    for (const sim::MapKind& kind : sim::map_kinds()) {
      if (records_.maps() != nullptr) {
        all.push_back({kind.name, kind.unit, kind.description, 1});
      }
    }
    return all;
  }

  [[nodiscard]] Raster map(const std::string& name) const override {
    const std::vector<sim::MapKind>& kinds = sim::map_kinds();
    const auto found = std::ranges::find_if(kinds, [&](const auto& kind) { return name == kind.name; });
    if (records_.maps() == nullptr || found == kinds.end()) {
      throw UserError("no map {}. Only 3D cases have maps; `maps` lists them.", name);
    }
    return records_.maps()->raster(*found, sim::MapExtent::whole_grid);
  }

  [[nodiscard]] NodeTable nodes() const override {
    constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    constexpr std::size_t record_size = mpm::record_size(mpm::components_of<mpm::Momentum, Dim>);
    NodeTable table{Dim, {}, {}, {}};
    const sim::MomentumOfNodes nodes = simulation_->momentum_of_nodes();
    const double* record = nodes.records.data();
    for (const std::uint64_t block : nodes.blocks) {
      const auto positions = positions_of_block(block);
      for (std::size_t k = 0; k < block_nodes; ++k, record += record_size) {
        const double mass = record[mpm::MomentumLayout<Dim>::mass];
        for (std::size_t a = 0; mass > 0.0 && a < Dim; ++a) {
          table.position.push_back(positions[k][static_cast<int>(a)]);
          table.velocity.push_back(record[mpm::MomentumLayout<Dim>::momentum + a] / mass);
        }
        if (mass > 0.0) {
          table.mass.push_back(mass);
        }
      }
    }
    return table;
  }

  [[nodiscard]] std::vector<FieldDescription> fields() const override {
    std::vector<FieldDescription> all;
    for (const mpm::FieldBase* field : std::as_const(*simulation_).particles().fields.all()) {
      if (is_public(*field)) {
        const char* meaning = field->info().meaning;
        all.push_back({field->info().name, field->info().unit,
                       meaning != nullptr ? meaning : "position relative to the domain's lower corner",
                       field->components()});
      }
    }
    return all;
  }

  [[nodiscard]] FieldMemory field(const std::string& name) override {
    const mpm::Particles<Dim>& particles = std::as_const(*simulation_).particles();
    for (const mpm::FieldBase* field : particles.fields.all()) {
      if (name == field->info().name && is_public(*field)) {
        constexpr std::size_t lanes = mpm::particles_of_block;
        return {simulation_,
                field->memory(),
                particles.size(),
                (particles.size() + lanes - 1) / lanes,
                field->components(),
                lanes,
                field->is_integer(),
                field->number_bytes(),
                simulation_->bed() != nullptr || simulation_->model().splits_stretched};
      }
    }
    std::vector<std::string> names;
    for (const FieldDescription& each : fields()) {
      names.push_back(each.name);
    }
    throw UserError("there is no particle field '{}'; allowed: {}.", name, fmt::join(names, ", "));
  }

  void change(const config::Case& next, const std::vector<std::string>& sets) override {
    config::require_changeable(sets);
    require_same_guards(parameters(), next);
    require_end_ahead(next.time.end, simulation_->time(), simulation_->last_step());
    replace(std::make_shared<Simulation>(next, simulation_->site()), checkpoint());
    if (simulation_->ends_at_rest() && config::keys_of(sets) != std::set<std::string>{"time.end"}) {
      simulation_->restart_rest_time();
    }
    Warnings(&observer_).add(config::notices(next));
  }

  [[nodiscard]] std::string checkpoint() const override {
    require_intact_device();
    if (const std::string& left = simulation_->left_text(); !left.empty()) {
      throw UserError("no particles are left to continue with: {}", left);
    }
    NamedNumbers blocks = records_.state();
    add_state<Dim>(*simulation_, blocks);
    for (std::size_t c = 0; c < history_.front().size(); ++c) {
      std::vector<double>& column = blocks[history_block + history_.front()[c].first];
      for (const sim::HistoryRow& row : history_) {
        column.push_back(row[c].second);
      }
    }
    return io::checkpoint_bytes<Dim>(std::as_const(*simulation_).particles(), simulation_->particles_at_start(),
                                     simulation_->scalars(), blocks, config::resolved_toml(parameters(), ""));
  }

  void restore(const std::string& checkpoint) override {
    const std::string of_checkpoint = io::case_of(io::intact_checkpoint(checkpoint_title, checkpoint));
    const std::vector<std::string> other = config::differences(config::resolved_toml(parameters(), ""), of_checkpoint);
    if (!other.empty()) {
      throw UserError("the checkpoint is of another case: {}. Restore it in a simulation of its case.",
                      fmt::join(other, "; "));
    }
    replace(std::make_shared<Simulation>(parameters(), simulation_->site()), checkpoint);
  }

 private:
  static constexpr const char* history_block = "history/";
  static constexpr const char* checkpoint_title = "the checkpoint";

  // The particles of a failed device are those of its last copy.
  void require_intact_device() const {
    if (simulation_->device_has_failed()) {
      throw UserError("the device has failed. Restore a checkpoint, or make a new simulation.");
    }
  }
  // Continues with another simulation, initialized at t = 0, from a checkpoint.
  void replace(std::shared_ptr<Simulation> next, const std::string& checkpoint) {
    const io::WholeCheckpoint state = io::intact_checkpoint(checkpoint_title, checkpoint);
    std::vector<double> scalars;
    const NamedNumbers blocks = io::read_checkpoint<Dim>(state, next->particles(), scalars);
    restore_state<Dim>(*next, scalars, blocks);
    sim::RunRecords<Dim> records(*next, next->site());
    records.restore(blocks);
    std::vector<sim::HistoryRow> rows = rows_of(records.history_row(*next), blocks);
    static_cast<void>(simulation_->particles());  // ends its use of a device, although views may keep it
    use_device<Dim>(device_, *next);
    simulation_ = std::move(next);
    records_ = std::move(records);
    history_ = std::move(rows);
    const double time = simulation_->time(), last_step = simulation_->last_step();
    history_schedule_ = history_schedule(parameters().time, time, last_step);
    snapshot_schedule_ = snapshot_schedule(parameters().time, time, last_step);
  }

  // Rows of a checkpoint, with columns in the order of those of a row.
  static std::vector<sim::HistoryRow> rows_of(const sim::HistoryRow& row, const NamedNumbers& blocks) {
    std::vector<sim::HistoryRow> rows;
    for (const auto& [name, value] : row) {
      const std::vector<double>& column = block_of(blocks, (history_block + name).c_str());
      rows.resize(column.size());
      for (std::size_t k = 0; k < column.size(); ++k) {
        rows[k].emplace_back(name, column[k]);
      }
    }
    return rows;
  }

  static bool is_public(const mpm::FieldBase& field) {
    return field.memory() != nullptr && (field.info().in_snapshot() || std::string("position") == field.info().name);
  }
  // Positions of the nodes of a block [m]. On terrain, columns of nodes begin at the height of the ground.
  [[nodiscard]] auto positions_of_block(std::uint64_t block) const {
    using T = mpm::Tile<Dim>;
    constexpr auto block_nodes = static_cast<std::size_t>(T::nodes);
    const sim::Model<Dim>& model = simulation_->model();
    const typename T::Index first = terrain::first_node_of<Dim>(block);
    std::array<terrain::GroundAtNode<Dim>, block_nodes> ground;
    if (model.ground) {
      model.ground->at_block(first, T::edge, ground.data());
    }
    std::array<Vector<double, Dim>, block_nodes> positions;
    for (std::size_t k = 0; k < block_nodes; ++k) {
      const typename T::Index node = T::node({}, static_cast<int>(k));
      for (std::size_t a = 0; a < Dim; ++a) {
        const bool is_height = model.ground && a + 1 == Dim;
        positions[k][static_cast<int>(a)] =
            model.origin[static_cast<int>(a)] +
            (is_height ? ground[k].elevation : static_cast<double>(first[a] + node[a]) * parameters().grid.cell);
      }
    }
    return positions;
  }

  void add_row() { history_.push_back(records_.history_row(*simulation_)); }

  Observer& observer_;
  std::string device_;
  std::shared_ptr<Simulation> simulation_;  // shared with views of its fields
  sim::RunRecords<Dim> records_;
  Schedule history_schedule_, snapshot_schedule_;
  StepWarnings warnings_;
  std::vector<sim::HistoryRow> history_;
};

}  // namespace

std::unique_ptr<LiveRun> make_live_run(const config::Case& parameters, const std::string& device, Observer& observer) {
  Warnings warnings(&observer);
  const config::Site site = read_map_files(parameters, warnings);
  return with_dimension(parameters.general.dimension,
                        [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) -> std::unique_ptr<LiveRun> {
                          auto live = std::make_unique<LiveRunOf<Dim>>(parameters, site, device, warnings, observer);
                          return live;
                        });
}

}  // namespace thawslide::run
