// Whether there is a card, and which.
#pragma once

#include <string>

namespace thawslide::card_test {

struct Card {
  bool is_usable = false;
  std::string name, why_not;
};
Card find_card();

}  // namespace thawslide::card_test
