#include "terrain/following_ground.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "base/parallel.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/shape.hpp"

namespace thawslide::terrain {

namespace {

// Bends of the terrain beyond this multiple of those of the columns' heights are not counted. On thalwegs of V
// channels, terrain bends 2.0 to 2.3 times as much.
constexpr double most_bend = 3.0;
// Bends from which a node's plane counts for the clearance, and beyond which it counts fully.
constexpr double kink_begins = 1.01, kink_ends = 1.05;

// Column of a chunk by its number in it, x fastest.
template <int Dim>
std::array<int, Dim - 1> column_of_chunk(std::array<int, Dim - 1> first, int number) {
  for (int& along : first) {
    along += number % chunk_edge;
    number /= chunk_edge;
  }
  return first;
}

}  // namespace

template <int Dim>
FollowingGround<Dim>::FollowingGround(std::shared_ptr<const Surface<Dim>> terrain, double cell, const Point& extent,
                                      const mpm::BodySizes& sizes, mpm::SectionWidth width, double steepest)
    : terrain_(std::move(terrain)), cell_(cell), sizes_(sizes), width_(std::move(width)) {
  std::size_t count = 1;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    columns_.columns[a] = static_cast<int>(std::lround(extent[static_cast<int>(a)] / cell)) + 1 + 2 * column_margin;
    columns_.chunks[a] = (columns_.columns[a] + chunk_edge - 1) / chunk_edge;
    count *= static_cast<std::size_t>(columns_.chunks[a]);
  }
  made_ = std::vector<std::atomic<Chunk*>>(count);
  limit_slopes(steepest);
}

template <int Dim>
FollowingGround<Dim>::~FollowingGround() {
  for (std::atomic<Chunk*>& chunk : made_) {
    delete chunk.load();
  }
}

template <int Dim>
typename FollowingGround<Dim>::Column FollowingGround<Dim>::first_of_chunk(std::size_t chunk) const {
  Column first{};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    first[a] = static_cast<int>(chunk % static_cast<std::size_t>(columns_.chunks[a])) * chunk_edge - column_margin;
    chunk /= static_cast<std::size_t>(columns_.chunks[a]);
  }
  return first;
}

template <int Dim>
typename FollowingGround<Dim>::Point FollowingGround<Dim>::place_of(const Column& column) const {
  Point place;
  for (int a = 0; a + 1 < Dim; ++a) {
    place[a] = static_cast<double>(column[static_cast<std::size_t>(a)]) * cell_;
  }
  return place;
}

// Two threads may compute the same chunk; one of the equal results is kept.
template <int Dim>
typename FollowingGround<Dim>::Chunk& FollowingGround<Dim>::means_of_chunk(std::size_t chunk) const {
  Chunk* known = made_[chunk].load(std::memory_order_acquire);
  if (known != nullptr) {
    return *known;
  }
  const Column first = first_of_chunk(chunk);
  auto means = std::make_unique<Chunk>();
  for (int c = 0; c < ColumnChunks<Dim>::size; ++c) {
    const auto of_column = terrain_->column_means(place_of(column_of_chunk<Dim>(first, c)), cell_);
    means->height[static_cast<std::size_t>(c)] = of_column.height;
    means->area[static_cast<std::size_t>(c)] = of_column.area;
  }
  return made_[chunk].compare_exchange_strong(known, means.get(), std::memory_order_acq_rel) ? *means.release()
                                                                                             : *known;
}

template <int Dim>
double& FollowingGround<Dim>::column_height(const Column& column) const {
  const auto place = columns_.place_of(column);
  return means_of_chunk(place.chunk).height[place.column];
}

template <int Dim>
std::vector<double> FollowingGround<Dim>::column_heights() const {
  constexpr auto size = static_cast<std::size_t>(ColumnChunks<Dim>::size);
  std::vector<double> heights(made_.size() * size);
  parallel_for(made_.size(), [&](std::size_t chunk) {
    std::copy_n(means_of_chunk(chunk).height.begin(), size,
                heights.begin() + static_cast<std::ptrdiff_t>(chunk * size));
  });
  return heights;
}

// Chunks with terrain steeper than a gradient within reach of the hat functions of its columns and their neighbours.
template <int Dim>
std::vector<std::size_t> FollowingGround<Dim>::chunks_steeper_than(double steepest) const {
  std::vector<std::uint8_t> is_steep(made_.size());
  parallel_for(made_.size(), [&](std::size_t chunk) {
    const Point from = place_of(first_of_chunk(chunk)) - Point::Constant(2.0 * cell_);
    is_steep[chunk] = terrain_->steepest(from, from + Point::Constant((chunk_edge + 3) * cell_)) > steepest ? 1 : 0;
    if (is_steep[chunk] != 0) {
      static_cast<void>(means_of_chunk(chunk));
    }
  });
  std::vector<std::size_t> found;
  for (std::size_t chunk = 0; chunk < made_.size(); ++chunk) {
    if (is_steep[chunk] != 0) {
      found.push_back(chunk);
    }
  }
  return found;
}

// Distances are those of paths through neighbouring columns, diagonals included. Heights are processed in ascending
// order, so that each column is lowered once.
template <int Dim>
void FollowingGround<Dim>::limit_slopes(double steepest) {
  constexpr double round_off = 1e-9;  // of a cell
  using Height = std::pair<double, Column>;
  std::priority_queue<Height, std::vector<Height>, std::greater<>> lower;
  const auto compare_neighbours = [&](const Column& column) {
    const double from = column_height(column);
    for (int j = -1; j <= (Dim == 3 ? 1 : -1); ++j) {
      for (int i = -1; i <= 1; ++i) {
        const std::array<int, 2> step{i, Dim == 3 ? j : 0};
        Column about = column;
        bool exists = true;
        for (std::size_t a = 0; a + 1 < Dim; ++a) {
          about[a] += step[a];
          exists = exists && about[a] >= -column_margin && about[a] < columns_.columns[a] - column_margin;
        }
        const double height = from + steepest * std::hypot(step[0], step[1]) * cell_;
        if (exists && column_height(about) > height + round_off * cell_) {
          lower.emplace(height, about);
        }
      }
    }
  };
  for (const std::size_t chunk : chunks_steeper_than(steepest)) {
    for (int c = 0; c < ColumnChunks<Dim>::size; ++c) {
      compare_neighbours(column_of_chunk<Dim>(first_of_chunk(chunk), c));
    }
  }
  std::map<Column, double> lowered;  // with the former height
  while (!lower.empty()) {
    const auto [height, column] = lower.top();
    lower.pop();
    if (double& present = column_height(column); present > height) {
      lowered.emplace(column, present);
      present = height;
      compare_neighbours(column);
    }
  }
  for (const auto& [column, former] : lowered) {
    bool is_inside = terrain_->is_known(place_of(column));
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      is_inside = is_inside && column[a] >= 0 && column[a] < columns_.columns[a] - 2 * column_margin;
    }
    if (is_inside) {
      ++lowering_.columns;
      if (const double change = former - column_height(column); change > lowering_.largest) {
        lowering_.largest = change;
        lowering_.place = place_of(column);
      }
    }
  }
}

template <int Dim>
GroundBelow<Dim> FollowingGround<Dim>::below(const Point& point, double half) const {
  return ground_below<Dim, double>(point, half, cell_, columns_,
                                   [this](const Column& column) { return column_height(column); });
}

template <int Dim>
double FollowingGround<Dim>::height(const Point& point) const {
  return height(point, 0);
}

template <int Dim>
typename FollowingGround<Dim>::Point FollowingGround<Dim>::gradient(const Point& point, double width) const {
  constexpr double round_off = 1e-9;
  return width > (1.0 + round_off) * cell_ ? terrain_->gradient(point, width) : below(point, sizes_.half(0)).slope;
}

// In three dimensions, heights are bilinear between four columns; three Gauss points along each axis.
template <int Dim>
typename FollowingGround<Dim>::Resolved FollowingGround<Dim>::resolved(const Column& column) const {
  Resolved found{Point::Zero(), 0.0, 0.0, 0.0};
  if constexpr (Dim == 2) {
    const double left = column_height({column[0] - 1}), here = column_height(column),
                 right = column_height({column[0] + 1});
    found.slope[0] = 0.5 * (right - left) / cell_;
    found.area = 0.5 * (std::hypot(1.0, (here - left) / cell_) + std::hypot(1.0, (right - here) / cell_));
    found.middle = (left + 4.0 * here + right) / 6.0;
  } else {
    static const double root = std::sqrt(0.6);
    const double place[3] = {0.5 - 0.5 * root, 0.5, 0.5 + 0.5 * root};
    constexpr double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0}, of_row[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    double b[3][3];
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        b[j][i] = column_height({column[0] + i - 1, column[1] + j - 1});
        found.middle += of_row[j] * of_row[i] * b[j][i];
      }
    }
    for (int row = 0; row < 2; ++row) {
      for (int side = 0; side < 2; ++side) {
        const double south = b[row][side + 1] - b[row][side], north = b[row + 1][side + 1] - b[row + 1][side];
        const double west = b[row + 1][side] - b[row][side], east = b[row + 1][side + 1] - b[row][side + 1];
        for (int q = 0; q < 9; ++q) {
          const double u = place[q % 3], v = place[q / 3];
          const double of_hat = weight[q % 3] * weight[q / 3] * (side == 0 ? u : 1.0 - u) * (row == 0 ? v : 1.0 - v);
          const Point slope((south * (1.0 - v) + north * v) / cell_, (west * (1.0 - u) + east * u) / cell_);
          found.slope += of_hat * slope;
          found.area += of_hat * std::hypot(1.0, slope.norm());
        }
      }
    }
  }
  found.resultant = std::hypot(1.0, found.slope.norm());
  return found;
}

template <int Dim>
double FollowingGround<Dim>::largest_bend_about(const Column& column) const {
  double largest = 1.0;
  for (int j = -1; j <= (Dim == 3 ? 1 : -1); ++j) {
    for (int i = -1; i <= 1; ++i) {
      Column about = column;
      about[0] += i;
      if constexpr (Dim == 3) {
        about[1] += j;
      }
      largest = std::max(largest, resolved(about).bend());
    }
  }
  return largest;
}

template <int Dim>
void FollowingGround<Dim>::at_block(const NodeIndex& first, int edge, GroundAtNode<Dim>* nodes) const {
  const double face = std::pow(cell_, Dim - 1);
  int columns = 1;
  for (int a = 0; a + 1 < Dim; ++a) {
    columns *= edge;
  }
  const bool is_above = first[Dim - 1] > 0;
  for (int c = 0; c < columns; ++c) {
    Column at{};
    for (int a = 0, rest = c; a + 1 < Dim; ++a, rest /= edge) {
      at[static_cast<std::size_t>(a)] = first[static_cast<std::size_t>(a)] + rest % edge;
    }
    const Point point = place_of(at);
    const Resolved ground = resolved(at);
    const auto place = columns_.place_of(at);
    const Chunk& means = means_of_chunk(place.chunk);
    const double height = means.height[place.column];
    double bend = 1.0, scale = 0.0;
    if (!is_above) {
      const double of_terrain = means.area[place.column] / ground.resultant;
      bend = std::max(1.0, std::min(of_terrain, 1.0 + most_bend * (largest_bend_about(at) - 1.0)));
      scale = ground.resultant * std::clamp((ground.bend() - kink_begins) / (kink_ends - kink_begins), 0.0, 1.0);
    }
    Vector<double, Dim> normal, middle;
    normal.template head<Dim - 1>() = ground.slope;
    normal[Dim - 1] = -1.0;
    normal /= ground.resultant;
    middle.template head<Dim - 1>() = point;
    middle[Dim - 1] = ground.middle;
    const double across = Dim == 2 ? width_.at(point[0]) : 1.0;
    for (int k = 0; k < edge; ++k) {
      const int layer = first[Dim - 1] + k;
      GroundAtNode<Dim>& node = nodes[c + k * columns];
      node.substrate = 0;
      node.candidate = layer <= 0;
      node.elevation = height + layer * cell_;
      node.normal = normal;
      node.bend = bend;
      node.area = layer == 0 ? across * face * bend * ground.resultant : 0.0;
      node.plane_scale = node.candidate ? scale : 0.0;
      node.plane = node.candidate ? scale * normal.dot(middle) : HUGE_VAL;
    }
  }
}

template <int Dim>
void FollowingGround<Dim>::locate(mpm::Particles<Dim>& particles) const {
  using Lanes = mpm::SimdBatch::Value;
  constexpr std::size_t count = Dim == 2 ? 3 : 9;
  struct Heights {
    const FollowingGround* ground;

    // Most particles lie in the same columns as the one before.
    void around(const std::array<Lanes, Dim - 1>& lowest, std::array<Lanes, count>& heights) const {
      alignas(sizeof(Lanes)) double by_lane[count][mpm::SimdBatch::most];
      Column last{};
      for (std::size_t lane = 0; lane < mpm::SimdBatch::most; ++lane) {
        Column column;
        for (std::size_t a = 0; a + 1 < Dim; ++a) {
          column[a] = static_cast<int>(lowest[a][lane]);
        }
        const bool is_known = lane > 0 && column == last;
        for (std::size_t k = 0; k < count; ++k) {
          Column about = column;
          about[0] += static_cast<int>(k % 3);
          if constexpr (Dim == 3) {
            about[1] += static_cast<int>(k / 3);
          }
          by_lane[k][lane] = is_known ? by_lane[k][lane - 1] : ground->column_height(about);
        }
        last = column;
      }
      for (std::size_t k = 0; k < count; ++k) {
        heights[k] = Lanes::load(by_lane[k]);
      }
    }
  };
  mpm::for_particles_in_memory(particles, LocateAboveGround<Dim, Heights>{columns_, {this}, sizes_.view(), cell_});
}

template class FollowingGround<2>;
template class FollowingGround<3>;

}  // namespace thawslide::terrain
