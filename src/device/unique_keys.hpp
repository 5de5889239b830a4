// Unique keys of an ascending list.
#pragma once

#include "device/array.hpp"
#include "device/cell_kernels.hpp"

namespace thawslide::device {

template <class Backend>
class UniqueKeys {
 public:
  explicit UniqueKeys(Backend& backend) : backend_(backend) {}

  // Finds the unique keys of a list, ignoring bits below `shift`, and optionally the places at which they begin.
  void find(const Array<std::uint64_t, Backend>& keys, int shift, Array<std::uint64_t, Backend>& found,
            Array<std::uint32_t, Backend>* indices) {
    const std::size_t count = keys.size();
    is_first_.resize(count);
    number_.resize(count);
    backend_.for_each(count, MarkFirst{keys.data(), shift, is_first_.data()});
    backend_.sum_before(is_first_.data(), number_.data(), count);
    const std::size_t different = count > 0 ? number_.get(count - 1) + is_first_.get(count - 1) : 0;
    found.resize(different);
    if (indices != nullptr) {
      indices->resize(different);
    }
    backend_.for_each(count, KeepFirst{keys.data(), shift, is_first_.data(), number_.data(), found.data(),
                                       indices != nullptr ? indices->data() : nullptr});
  }

  // For the last list, by place: whether a key begins there, and how many keys begin before.
  [[nodiscard]] const std::uint32_t* is_first() const { return is_first_.data(); }
  [[nodiscard]] const std::uint32_t* number() const { return number_.data(); }

 private:
  Backend& backend_;
  Array<std::uint32_t, Backend> is_first_{backend_}, number_{backend_};
};

}  // namespace thawslide::device
