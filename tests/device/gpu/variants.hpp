// Model options other than those of slide.hpp, among them band columns and an erodible bed.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "../../cpp/physics/band_column_model.hpp"
#include "../emulated.hpp"
#include "slide.hpp"

namespace thawslide::gpu_test {

enum class Variant {
  plain,
  elastic,
  quadratic,
  apic,
  filtered,
  heated_face,
  published_heat,
  at_rest,
  unknown_ground,
  columns,
  bed,
  bodies,
  stages,
  width
};

struct NamedVariant {
  Variant variant;
  const char* name;
};
inline constexpr std::array<NamedVariant, 14> variants{{{Variant::plain, "as it is"},
                                                        {Variant::elastic, "without yielding"},
                                                        {Variant::quadratic, "quadratic shape functions"},
                                                        {Variant::apic, "APIC"},
                                                        {Variant::filtered, "velocity filter"},
                                                        {Variant::heated_face, "heat through a face"},
                                                        {Variant::published_heat, "published update of heat"},
                                                        {Variant::at_rest, "heat and pressure alone"},
                                                        {Variant::unknown_ground, "ground not known everywhere"},
                                                        {Variant::columns, "band columns"},
                                                        {Variant::bed, "erodible bed"},
                                                        {Variant::bodies, "contact between bodies"},
                                                        {Variant::stages, "release in stages"},
                                                        {Variant::width, "varying width (2D)"}}};

// The rear half of the slide becomes a second body if the variant has two.
template <int Dim>
void seed_bodies(Variant variant, const Size& size, ParticleMemory<Dim>& memory) {
  const mpm::ParticleView<Dim>& p = memory.view();
  for (std::size_t k = 0; (variant == Variant::bodies || variant == Variant::stages) && k < memory.size(); ++k) {
    p.body(k) = p.position(k, 0) < (16.0 + 0.5 * static_cast<double>(size.length)) * cell ? 1 : 0;
  }
}

template <int Dim>
device::StepModel<Dim> model_of(Variant variant) {
  device::StepModel<Dim> model = model_of_slide<Dim>();
  switch (variant) {
    case Variant::elastic:
      model.motion.materials[0].law = physics::LinearElastic{};
      break;
    case Variant::quadratic:
      model.motion.shape = mpm::ShapeFunction::quadratic;
      break;
    case Variant::apic:
      model.motion.shape = mpm::ShapeFunction::quadratic;
      model.motion.transfer = mpm::TransferKind::apic;
      break;
    case Variant::filtered:
      model.motion.filter_order = 2;
      model.filters_in_step = [](double /*time*/, double /*dt*/) { return true; };
      break;
    case Variant::heated_face:
      model.band.at_faces.extent.setConstant(1e5);
      model.band.at_faces.extent[0] = 20.0;  // within the slide: all nodes beyond it count
      model.band.at_faces.faces[1] = {band::HeatBoundaryKind::flux, 500.0};
      break;
    case Variant::published_heat:
      model.band.secant_capacity = false;
      break;
    case Variant::at_rest:
      model.moves = false;
      break;
    case Variant::columns:  // as in sim::step_model_of
      model.band.heat = model.band.pressure = false;
      model.contact.band_columns = true;
      model.band_columns.emplace();
      model.band_columns->column = physics::make_model();
      model.band_columns->body_temperature = model.band_columns->ground_temperature = -2.0;
      model.band_columns->density = 2000.0;
      model.band_columns->load_time = 0.1;
      model.band_columns->step = 0.5 * time_step;  // stepped in each step
      model.band_columns->largest_thickness = 40.0;
      model.band_thickness = [](double /*time*/) { return 0.2; };
      break;
    case Variant::bodies:
      model.half_sizes.push_back(model.half_sizes[0]);
      model.between_bodies = {{0, 1}, 2, false, {mpm::rough, 0.3, 0.3, mpm::rough}};
      model.layers_of_bodies = [](double /*time*/) { return std::vector<std::uint8_t>{0, 1}; };
      break;
    case Variant::stages:
      model.half_sizes.push_back(model.half_sizes[0]);
      model.between_bodies = {{0, 0}, 1, true, {mpm::rough}};
      model.layers_of_bodies = [](double time) {
        return std::vector<std::uint8_t>{0, static_cast<std::uint8_t>(time < 5.5 * time_step ? 1 : 0)};
      };
      break;
    case Variant::width:
      if (Dim == 2) {
        model.width = mpm::SectionWidth({{14.0, 20.0, 26.0}, {10.0, 25.0, 15.0}}, 0.0);
      }
      break;
    case Variant::plain:
    case Variant::unknown_ground:
    case Variant::bed:
      break;
  }
  return model;
}

// State of the base other than particles: of the bed, which is on the CPU, or of the basal segments.
struct Reported {
  std::function<std::vector<double>()> bed = [] { return std::vector<double>(); };
};
template <int Dim>
std::vector<double> state_of_base(Variant variant, const Reported& reported, const device::Solver<Dim>& steps) {
  std::vector<double> numbers = reported.bed();
  if (variant == Variant::columns) {
    for (const band::BasalSegment<Dim>& segment : steps.segments().segments) {
      numbers.insert(numbers.end(), segment.position.begin(), segment.position.end());
      numbers.insert(numbers.end(), segment.velocity.begin(), segment.velocity.end());
      numbers.insert(numbers.end(), {segment.area, segment.slip, segment.load, segment.depth, segment.liquid});
      numbers.insert(numbers.end(), segment.column.temperature, segment.column.temperature + physics::ColumnCells::all);
    }
  }
  return numbers;
}

// Uniform bed over the part of the plane that the slide reaches.
template <int Dim>
std::shared_ptr<terrain::Bed<Dim>> bed_below() {
  typename terrain::Bed<Dim>::Column columns;
  columns.fill(64);
  const terrain::BedMaterial material{terrain::BedLaw::strength, 0.0, 0.01, 0.5, 1000.0};
  return std::make_shared<terrain::Bed<Dim>>(
      material, columns, std::vector<double>(static_cast<std::size_t>(mpm::power(64, Dim - 1)), 10.0));
}

template <int Dim>
device::HostCallbacks<Dim> processor_of(Variant variant, const std::shared_ptr<Reported>& specified) {
  device::HostCallbacks<Dim> ask = terrain_of_slide<Dim>();
  if (variant == Variant::unknown_ground) {
    ask.ground = [](std::uint64_t block, terrain::GroundAtNode<Dim>* nodes) {
      query_ground<Dim>(block, nodes);
      return mpm::Tile<Dim>::index(block)[0] < 5;
    };
  }
  if (variant == Variant::bed) {
    const auto bed = bed_below<Dim>();
    ask.bed = bed.get();
    specified->bed = [bed] { return bed->state(); };
  }
  return ask;
}

// Steps of the block on a GPU, or emulated on the CPU.
template <int Dim>
using Steps = device::Solver<Dim>;

// specified: record of the data that the CPU receives during steps.
template <int Dim>
std::unique_ptr<Steps<Dim>> steps_of(const device::SolverFactory<Dim>& make, const ParticleMemory<Dim>& particles,
                                     Variant variant = Variant::plain,
                                     const std::shared_ptr<Reported>& specified = std::make_shared<Reported>()) {
  return make(model_of<Dim>(variant), particles.view(), particles.size(), processor_of<Dim>(variant, specified));
}

}  // namespace thawslide::gpu_test
