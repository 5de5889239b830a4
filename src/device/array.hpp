// Array in device memory. A backend, Host (device/host_backend.hpp) or Cuda (device/cuda_backend.hpp), allocates
// memory, launches one thread or one thread group per item, sorts, and computes prefix sums.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace thawslide::device {

template <class T, class Backend>
class Array {
 public:
  explicit Array(Backend& backend, std::size_t count = 0) : backend_(&backend) { resize(count); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() {
    if (numbers_ != nullptr) {
      backend_->release(numbers_);
    }
  }

  void swap(Array& other) noexcept {
    std::swap(backend_, other.backend_);
    std::swap(numbers_, other.numbers_);
    std::swap(count_, other.count_);
    std::swap(capacity_, other.capacity_);
  }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] T* data() { return numbers_; }
  [[nodiscard]] const T* data() const { return numbers_; }

  // Reallocation discards the contents.
  void resize(std::size_t count) {
    if (count > capacity_) {
      if (numbers_ != nullptr) {
        backend_->release(std::exchange(numbers_, nullptr));
      }
      const std::size_t capacity = std::exchange(capacity_, 0) == 0 ? count : count + count / 4;
      numbers_ = backend_->template allocate<T>(capacity);
      capacity_ = capacity;
    }
    count_ = count;
  }

  void set(const std::vector<T>& numbers) {
    resize(numbers.size());
    backend_->copy_in(numbers_, numbers.data(), count_);
  }
  [[nodiscard]] std::vector<T> get() const {
    std::vector<T> numbers(count_);
    backend_->copy_out(numbers.data(), numbers_, count_);
    return numbers;
  }
  [[nodiscard]] T get(std::size_t k) const {
    T number;
    backend_->copy_out(&number, numbers_ + k, 1);
    return number;
  }

 private:
  Backend* backend_ = nullptr;
  T* numbers_ = nullptr;
  std::size_t count_ = 0, capacity_ = 0;
};

}  // namespace thawslide::device
