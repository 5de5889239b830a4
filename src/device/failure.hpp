// Error of a device.
#pragma once

#include <stdexcept>

namespace thawslide::device {

// The message states which operation failed.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace thawslide::device
