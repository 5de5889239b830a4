// What src/device/card.cu says of a card, said of the processor in a card's place: `thawslide run --device gpu` then
// takes its steps by the code of the card, thread after thread.
#include "device/card.hpp"

#include "../on_processor.hpp"

namespace thawslide::device {

template <int Dim>
MakeStep<Dim, double> on_card() {
  return on_processor<Dim>(ThreadOrder::shuffled);
}
template MakeStep<2, double> on_card<2>();
template MakeStep<3, double> on_card<3>();

Card find_card() { return {true, "the processor in a card's place", "", 8e9}; }

}  // namespace thawslide::device
