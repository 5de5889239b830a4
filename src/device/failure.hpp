// A device that fails.
#pragma once

#include <stdexcept>

namespace thawslide::device {

// Says what the device was doing.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace thawslide::device
