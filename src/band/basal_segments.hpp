// The base of a slide as pieces that each carry a band column: what contact nodes see of them, and what they take from
// these. Pieces move with the slide, part where they have become long, and are laid where the slide reaches new ground.
#pragma once

#include <functional>
#include <vector>

#include "band/segment_step.hpp"
#include "base/named_numbers.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::band {

// Sums over all pieces [J, kg, m2, m3]. Heat: with the friction heat that waits for the columns' next step.
template <class Real>
struct ColumnSums {
  Real area = 0, heat = 0, waiting_heat = 0, water = 0, opening = 0, gas_void = 0;

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

// What columns got and gave since the start [J], [kg]. Laid: with pieces that were laid; left: with those taken up.
template <class Real>
struct ColumnLedger {
  Real created_heat = 0, friction_heat = 0, body_heat = 0, ground_heat = 0, vented_heat = 0, steam_heat = 0,
       left_heat = 0;
  Real created_water = 0, body_water = 0, vented_water = 0, steam = 0, left_water = 0;

  template <class Visit>
  void for_each(const Visit& visit) {
    for (Real* account : {&created_heat, &friction_heat, &body_heat, &ground_heat, &vented_heat, &steam_heat,
                          &left_heat, &created_water, &body_water, &vented_water, &steam, &left_water}) {
      visit(*account);
    }
  }
};

// Means over the base, by area, and extremes.
template <class Real>
struct BaseMeans {
  Real temperature = 0, saturation = 0, pore_pressure = 0, load = 0, thickness = 0;
  Real hottest = 0, hottest_wet = 0;  // of any cell above the ground, and of those that hold water [C]
  Real dry_share = 0;                 // of the base: where some cell of the band has no water left
  Real largest_pressure_ratio = 0;    // of P over averaged N
};

template <int Dim, class Real>
class BasalSegments {
 public:
  // Of the ground below a horizontal place [m].
  struct Ground {
    std::function<Real(const Vector<Real, Dim - 1>&)> height;
    std::function<Vector<Real, Dim>(const Vector<Real, Dim - 1>&)> normal;  // into the ground
    std::function<Real(const Vector<Real, Dim - 1>&)> width;                // of a 2D section, relative; 1 in space

    // Of the ground below edges about a place [m2].
    [[nodiscard]] Real area_of(const Vector<Real, Dim>& place,
                               const typename BasalSegment<Dim, Real>::Sides& sides) const {
      return width(place.template head<Dim - 1>()) * band::area_of<Dim, Real>(sides);
    }
  };
  // Of a node: its unit normal into the ground and its distance above it [m]; null where the ground is not near.
  struct NodeGround {
    const Vector<Real, Dim>* normal;
    Real distance;
  };
  using NodeGroundOf = std::function<NodeGround(std::size_t block, std::size_t node)>;

  // gravity [m/s2].
  BasalSegments(ColumnsModel<Real> model, const Vector<Real, Dim>& gravity)
      : model_(std::move(model)), gravity_(gravity) {}

  // Fills nodes.base_state of the blocks with contact. Call it before each take, which uses the same stencils.
  void to_nodes(const mpm::SparseGrid<Dim, Real>& grid, mpm::Nodes<Dim, Real>& nodes);

  // After contact, at the positions that to_nodes has seen: what contact does in dt to all pieces (load, heat, slip),
  // new ones first where the slide touches ground that none covers. Then they move on by dt.
  void take(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground, const NodeGroundOf& node_ground,
            Real thickness, Real dt, mpm::Nodes<Dim, Real>& nodes);

  // Pieces take the velocity of the slide, and stretch with it as over the last `duration` [s]; those that have become
  // long part, and small ones join.
  void follow(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground, const NodeGroundOf& node_ground,
              Real duration, const mpm::Nodes<Dim, Real>& nodes);

  // Then steps all columns over it, at the end of which the case wants a band so thick [m].
  void step(Real thickness, Real duration);

  [[nodiscard]] const std::vector<BasalSegment<Dim, Real>>& segments() const { return segments_; }
  // Means of the column after its last step, with the pore pressure under the present load.
  [[nodiscard]] static physics::BandMeans<Real> means_now(const BasalSegment<Dim, Real>& segment) {
    physics::BandMeans<Real> means = segment.means;
    means.pore_pressure = physics::band_pressure(segment.load, segment.column);
    return means;
  }
  [[nodiscard]] physics::ColumnVolumes<Real> volumes_of(const BasalSegment<Dim, Real>& segment) const {
    return band::volumes_of(model_, segment);
  }
  [[nodiscard]] const ColumnLedger<Real>& ledger() const { return ledger_; }
  [[nodiscard]] ColumnSums<Real> sums() const;
  [[nodiscard]] BaseMeans<Real> means() const;

  // Everything a checkpoint must hold, and its way back.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  using Segment = BasalSegment<Dim, Real>;
  using Stencil = BaseStencil<Dim, Real>;

  using Lattice = std::array<int, Dim - 1>;  // a cell of the horizontal lattice on which pieces are laid
  // A part of a lattice cell. On steep ground a cell is divided along each axis, because a piece reaches only the nodes
  // of its stencil.
  struct LatticePart {
    Lattice cell, part, parts;  // parts: number along each axis
    auto operator<=>(const LatticePart&) const = default;
  };
  // Foot of a node in contact: its point on the ground, the lattice cell of this point, and the number of parts of a
  // cell on ground of this slope.
  struct Footpoint {
    Lattice cell, parts;
    Vector<Real, Dim> place;
  };
  // Its number of parts along each axis, on ground with this normal.
  [[nodiscard]] static Lattice parts_on(const Vector<Real, Dim>& normal);
  [[nodiscard]] Lattice lattice_part(const mpm::SparseGrid<Dim, Real>& grid, const Vector<Real, Dim>& place,
                                     const Lattice& cell, const Lattice& parts) const;
  [[nodiscard]] Lattice lattice_cell(const mpm::SparseGrid<Dim, Real>& grid, const Vector<Real, Dim>& place) const;
  [[nodiscard]] std::vector<Footpoint> contact_footpoints(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground,
                                                          const NodeGroundOf& node_ground,
                                                          const mpm::Nodes<Dim, Real>& nodes) const;
  [[nodiscard]] std::vector<LatticePart> parts_below(const mpm::SparseGrid<Dim, Real>& grid,
                                                     std::vector<Footpoint> footpoints) const;
  void leave_out_covered(const mpm::SparseGrid<Dim, Real>& grid, std::vector<LatticePart>& parts) const;
  [[nodiscard]] bool some_node_is_bare(const mpm::SparseGrid<Dim, Real>& grid,
                                       const mpm::Nodes<Dim, Real>& nodes) const;
  void create_segments(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground, const NodeGroundOf& node_ground,
                       Real thickness, mpm::Nodes<Dim, Real>& nodes);
  void list_segments_by_block(std::size_t blocks);
  void add_area(const Stencil& stencil, const Segment& segment, mpm::Nodes<Dim, Real>& nodes, Real share = 1) const;
  struct InContact {
    Real area = 0, normal_force = 0;  // [m2], [N]
  };
  void start_segment(const Stencil& stencil, const Ground& ground, const InContact& contact, Real thickness,
                     mpm::Nodes<Dim, Real>& nodes, Segment& segment);
  [[nodiscard]] InContact in_contact(const Stencil& stencil, const mpm::Nodes<Dim, Real>& nodes,
                                     const Segment& segment) const;
  [[nodiscard]] Segment new_segment(const Vector<Real, Dim - 1>& middle, const Vector<Real, Dim - 1>& size,
                                    const Ground& ground);
  // How the slide about a piece moves.
  struct Nearby {
    Matrix<Real, Dim> gradient = Matrix<Real, Dim>::Zero();  // of the velocity, along the ground [1/s]
    Vector<Real, Dim> velocity = Vector<Real, Dim>::Zero();  // along the ground [m/s]
    bool is_present = false;
  };
  [[nodiscard]] Nearby slide_near(const mpm::SparseGrid<Dim, Real>& grid, const Stencil& stencil,
                                  const NodeGroundOf& node_ground, const mpm::Nodes<Dim, Real>& nodes,
                                  const Segment& segment) const;
  void gather_from_nodes(const Stencil& stencil, Real dt, const mpm::Nodes<Dim, Real>& nodes, Segment& segment) const;
  void stretch_with(const Nearby& slide, const Ground& ground, Real dt, Segment& segment) const;
  void split_long_segments(Real most, const Ground& ground);
  void merge_small_segments(const mpm::SparseGrid<Dim, Real>& grid, const Ground& ground);
  void join(const Segment& other, const Ground& ground, Segment& segment);
  void keep_only(const std::vector<std::uint8_t>& left);
  void add_to_ledger(const physics::ColumnAccount<Real>& account);
  void remove_segment(const Segment& segment);
  void place_on(const Ground& ground, Segment& segment) const;
  void update_load(Real normal_pressure, Real borne, Real dt, Segment& segment) const;

  ColumnsModel<Real> model_;
  Vector<Real, Dim> gravity_;
  std::vector<Segment> segments_;
  // Stencils of this step, by piece, and the pieces whose stencils reach a block: those of b from first_of_block_[b]
  // on.
  std::vector<Stencil> stencils_;
  struct Seen {
    std::uint32_t segment;
    int corner;  // of the piece's stencil
  };
  std::vector<std::uint32_t> first_of_block_;
  std::vector<Seen> by_block_;
  ColumnLedger<Real> ledger_;
  std::int64_t next_id_ = 0;
  bool checks_gaps_ = true;
};

}  // namespace thawslide::band
