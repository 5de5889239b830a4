#include "base/error.hpp"

namespace thawslide {

void fail_assertion(const char* condition, const char* file, int line, const std::string& values) {
  throw InternalError(fmt::format("{}:{}: internal error: '{}' does not hold: {}", file, line, condition, values));
}

}  // namespace thawslide
