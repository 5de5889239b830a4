// What src/device/card.cu says of a card, said of the processor in a card's place: `thawslide run --device gpu` then
// takes its steps by the code of the card, thread after thread.
#include "device/card.hpp"

#include "../on_processor.hpp"

namespace thawslide::device {

template <int Dim>
MakeStep<Dim, double> on_card(Launching /*launching*/) {
  return on_processor<Dim>(ThreadOrder::shuffled);
}
template MakeStep<2, double> on_card<2>(Launching);
template MakeStep<3, double> on_card<3>(Launching);

Card find_card() { return {true, "the processor in a card's place", "", 8e9}; }

}  // namespace thawslide::device
