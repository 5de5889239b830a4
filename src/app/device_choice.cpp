#include "app/device_choice.hpp"

#include "base/error.hpp"
#ifdef THAWSLIDE_WITH_CARD
#include "device/card.hpp"
#endif

namespace thawslide::app {

namespace {

#ifdef THAWSLIDE_WITH_CARD
template <int Dim>
std::string take_steps_on_card(sim::Simulation<Dim, double>& simulation) {
  const device::Card card = device::find_card();
  if (!card.is_usable) {
    throw UserError(fmt::format("--device gpu: {}. Run it on the processor: --device cpu", card.why_not));
  }
  simulation.take_steps_on(card.name, device::on_card<Dim>());
  return card.name;
}
#else
template <int Dim>
std::string take_steps_on_card(sim::Simulation<Dim, double>& /*simulation*/) {
  throw UserError(
      "--device gpu: this program was built without CUDA. Install CUDA 12 or later and build again (./run --setup), or "
      "run it on the processor: --device cpu");
}
#endif

}  // namespace

CardFacts look_for_card() {
#ifdef THAWSLIDE_WITH_CARD
  const device::Card card = device::find_card();
  return {card.name, card.why_not, card.free, 0.0, 0.0};
#else
  return {"", "this program was built without CUDA", 0.0, 0.0, 0.0};
#endif
}

template <int Dim>
std::string take_steps_on(const std::string& device, sim::Simulation<Dim, double>& simulation) {
  if (device == "cpu") {
    return "";
  }
  try {
    return take_steps_on_card<Dim>(simulation);
  } catch (const UserError&) {
    if (device == "auto") {
      return "";
    }
    throw;
  }
}

template std::string take_steps_on<2>(const std::string&, sim::Simulation<2, double>&);
template std::string take_steps_on<3>(const std::string&, sim::Simulation<3, double>&);

}  // namespace thawslide::app
