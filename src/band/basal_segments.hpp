// Base of the sliding mass as segments that each carry a band column, and their exchange with contact nodes. Segments
// move with the sliding mass, split when they become long, and are created where it reaches new ground.
#pragma once

#include <functional>
#include <vector>

#include "band/base_stencil.hpp"
#include "band/segment_step.hpp"
#include "base/state_numbers.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::band {

// Sums over all segments [J, kg, m2, m3]. Heat includes the friction heat that is pending until the columns' next step.
struct ColumnSums {
  double area = 0, heat = 0, waiting_heat = 0, water = 0, opening = 0, gas_void = 0;

  ColumnSums& operator+=(const ColumnSums& part) {
    area += part.area;
    heat += part.heat;
    waiting_heat += part.waiting_heat;
    water += part.water;
    opening += part.opening;
    gas_void += part.gas_void;
    return *this;
  }
};

// Heat and water budget of all columns since the start [J], [kg]. created: with new segments; left: with removed
// segments.
struct ColumnLedger {
  double created_heat = 0, friction_heat = 0, body_heat = 0, ground_heat = 0, vented_heat = 0, steam_heat = 0,
         left_heat = 0;
  double created_water = 0, body_water = 0, vented_water = 0, steam = 0, left_water = 0;

  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* term : {&created_heat, &friction_heat, &body_heat, &ground_heat, &vented_heat, &steam_heat, &left_heat,
                         &created_water, &body_water, &vented_water, &steam, &left_water}) {
      visit(*term);
    }
  }
};

// Means over the base, weighted by area, and extremes.
struct BaseMeans {
  double temperature = 0, saturation = 0, pore_pressure = 0, load = 0, thickness = 0;
  double max_temperature = 0,
         max_wet_temperature = 0;  // maximum of all cells above the ground, and of those with water [C]
  double dry_fraction = 0;         // area fraction of the base in which a cell of the band has no water left
  double max_pressure_ratio = 0;   // maximum P over averaged N
};

template <int Dim>
class BasalSegments {
 public:
  // Ground below a horizontal position [m].
  struct Ground {
    std::function<double(const Vector<double, Dim - 1>&)> height;
    std::function<Vector<double, Dim>(const Vector<double, Dim - 1>&)> normal;  // into the ground
    std::function<double(const Vector<double, Dim - 1>&)> width;                // of a 2D section, relative; 1 in 3D

    // Area of ground spanned by edges around a position [m2].
    [[nodiscard]] double area_of(const Vector<double, Dim>& position,
                                 const typename BasalSegment<Dim>::Sides& sides) const {
      return width(position.template head<Dim - 1>()) * band::area_of<Dim>(sides);
    }
  };
  // Unit normal into the ground at a node; null if the ground is not near.
  using NormalAtNode = std::function<const Vector<double, Dim>*(std::size_t block, std::size_t node)>;

  // gravity [m/s2].
  BasalSegments(const ColumnsModel& model, const Vector<double, Dim>& gravity) : model_(model), gravity_(gravity) {}

  // Fills nodes.base_state of the blocks with contact: at nodes on the ground, and below them the same. Call before
  // each update_from_nodes, which uses the same stencils.
  void to_nodes(const mpm::SparseGrid<Dim>& grid, mpm::Nodes<Dim>& nodes);

  // Applies contact over dt to all segments (load, heat, slip) at the positions used by to_nodes, then moves them by
  // dt. First creates segments where the sliding mass touches ground without one. Call after contact.
  void update_from_nodes(const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal,
                         double thickness, double dt, mpm::Nodes<Dim>& nodes);

  // Updates segment velocities and stretches segments with the flow over the last `duration` [s]; then splits long
  // segments and merges small ones.
  void follow(const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal, double duration,
              const mpm::Nodes<Dim>& nodes);

  // Then steps all columns over `duration` [s]. thickness: prescribed band thickness at its end [m].
  void step(double thickness, double duration);

  [[nodiscard]] const std::vector<BasalSegment<Dim>>& segments() const { return segments_; }
  // Means of the column after its last step, with the pore pressure under the present load.
  [[nodiscard]] static physics::BandMeans current_means(const BasalSegment<Dim>& segment) {
    physics::BandMeans means = segment.means;
    means.pore_pressure = physics::band_pressure(segment.load, segment.column);
    return means;
  }
  [[nodiscard]] physics::ColumnVolumes volumes_of(const BasalSegment<Dim>& segment) const {
    return band::volumes_of(model_, segment);
  }
  [[nodiscard]] const ColumnLedger& budget() const { return budget_; }
  [[nodiscard]] ColumnSums sums() const;
  [[nodiscard]] BaseMeans means() const;

  // Checkpoint state.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  using Segment = BasalSegment<Dim>;
  using Stencil = BaseStencil<Dim>;
  using Patch = BasePatch<Dim>;

  using Lattice = std::array<int, Dim - 1>;  // cell of the horizontal lattice on which segments are created
  [[nodiscard]] Lattice lattice_cell(const mpm::SparseGrid<Dim>& grid, const Vector<double, Dim>& position) const;
  [[nodiscard]] std::vector<Lattice> cells_in_contact(const mpm::SparseGrid<Dim>& grid, const Ground& ground,
                                                      const mpm::Nodes<Dim>& nodes) const;
  void leave_out_covered(const mpm::SparseGrid<Dim>& grid, std::vector<Lattice>& cells) const;
  [[nodiscard]] bool some_node_is_bare(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes) const;
  void create_segments(const mpm::SparseGrid<Dim>& grid, const Ground& ground, const NormalAtNode& node_normal,
                       double thickness, mpm::Nodes<Dim>& nodes);
  void locate(const mpm::SparseGrid<Dim>& grid);
  [[nodiscard]] bool has_segments(std::size_t b) const { return first_of_block_[b] < first_of_block_[b + 1]; }
  // Calls visit(p) for the segments above block b.
  template <class Visit>
  void for_each_segment(std::size_t b, const Visit& visit) const {
    for (std::size_t n = first_of_block_[b]; n < first_of_block_[b + 1]; ++n) {
      visit(static_cast<std::size_t>(by_block_[n]));
    }
  }
  void add_area(const mpm::SparseGrid<Dim>& grid, const Stencil& stencil, const Segment& segment,
                mpm::Nodes<Dim>& nodes, double fraction = 1) const;
  // Contact of a node with those below it, or the part of a segment.
  struct InContact {
    double area = 0, normal_force = 0;   // [m2], [N]
    double slip = 0, friction_heat = 0;  // slip speed times area [m3/s], [W]
  };
  void sum_contact(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes);
  void start_segment(const mpm::SparseGrid<Dim>& grid, const Stencil& stencil, const Ground& ground,
                     const InContact& contact, double thickness, mpm::Nodes<Dim>& nodes, Segment& segment);
  [[nodiscard]] InContact in_contact(const mpm::SparseGrid<Dim>& grid, const Stencil& stencil,
                                     const mpm::Nodes<Dim>& nodes, const Segment& segment) const;
  [[nodiscard]] Segment new_segment(const Vector<double, Dim - 1>& middle, const Vector<double, Dim - 1>& size,
                                    const Ground& ground);
  // Motion of the sliding mass around a segment.
  struct Nearby {
    Matrix<double, Dim> gradient = Matrix<double, Dim>::Zero();  // of the velocity, along the ground [1/s]
    Vector<double, Dim> velocity = Vector<double, Dim>::Zero();  // along the ground [m/s]
    bool is_present = false;
  };
  // Sums over the nodes below, on and above the ground at one place of a patch, with the weights of the layers: mass
  // [kg] and momentum [N s], and both times the height in cells.
  struct ColumnMotion {
    double mass = 0, mass_height = 0, mass_squares = 0;  // mass_squares: with the height squared
    Vector<double, Dim> momentum = Vector<double, Dim>::Zero(), momentum_height = Vector<double, Dim>::Zero();
    const Vector<double, Dim>* normal = nullptr;
  };
  using PatchMotion = std::array<ColumnMotion, Patch::nodes>;
  [[nodiscard]] PatchMotion motion_about(const mpm::SparseGrid<Dim>& grid, std::int32_t b,
                                         const NormalAtNode& node_normal, const mpm::Nodes<Dim>& nodes) const;
  [[nodiscard]] Nearby slide_near(double cell, const Stencil& stencil, const PatchMotion& motion,
                                  const Segment& segment) const;
  void gather_from_nodes(const mpm::SparseGrid<Dim>& grid, std::size_t b, double dt, const mpm::Nodes<Dim>& nodes);
  void take_contact(const InContact& around, double heat, double pressure, double dt, Segment& segment) const;
  void stretch_with(const Nearby& slide, const Ground& ground, double dt, Segment& segment) const;
  void split_long_segments(double most, const Ground& ground);
  void merge_small_segments(const mpm::SparseGrid<Dim>& grid, const Ground& ground);
  void join(const Segment& other, const Ground& ground, Segment& segment);
  void keep_only(const std::vector<std::uint8_t>& left);
  void add_to_budget(const physics::ColumnBudget& term);
  void remove_segment(const Segment& segment);
  void place_on(const Ground& ground, Segment& segment) const;
  void update_load(double normal_pressure, double borne, double dt, Segment& segment) const;

  ColumnsModel model_;
  Vector<double, Dim> gravity_;
  std::vector<Segment> segments_;
  // Stencils of this step, by segment, and the segments above a block: those of block b begin at first_of_block_[b].
  std::vector<Stencil> stencils_;
  std::vector<std::uint32_t> first_of_block_, by_block_;
  std::vector<std::array<typename mpm::RecordsOf<mpm::BaseState, Dim>::Record, Patch::nodes>> patches_;  // by block
  std::vector<InContact> contact_;  // by block with nodes on the ground, and node of layer 0
  ColumnLedger budget_;
  std::int64_t next_id_ = 0;
  bool checks_gaps_ = true;
};

}  // namespace thawslide::band
