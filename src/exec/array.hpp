// Array in the memory of an executor: Cpu (exec/cpu.hpp), Cuda (device/cuda_backend.hpp), or Host, which emulates Cuda
// (device/host_backend.hpp). An executor allocates memory, launches one thread per item, sorts, and computes prefix
// sums; those of devices also launch one thread group per item.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace thawslide::exec {

template <class T, class Executor>
class Array {
 public:
  explicit Array(Executor& executor, std::size_t count = 0) : executor_(&executor) { resize(count); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() {
    if (numbers_ != nullptr) {
      executor_->release(numbers_);
    }
  }

  void swap(Array& other) noexcept {
    std::swap(executor_, other.executor_);
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
        executor_->release(std::exchange(numbers_, nullptr));
      }
      const std::size_t capacity = std::exchange(capacity_, 0) == 0 ? count : count + count / 4;
      numbers_ = executor_->template allocate<T>(capacity);
      capacity_ = capacity;
    }
    count_ = count;
  }

  // Resizes and keeps the contents.
  void grow(std::size_t count) {
    if (count > capacity_) {
      Array larger(*executor_, count + count / 4);
      executor_->copy(larger.numbers_, numbers_, count_);
      swap(larger);
    }
    count_ = count;
  }

  void set(const std::vector<T>& numbers) {
    resize(numbers.size());
    executor_->copy_in(numbers_, numbers.data(), count_);
  }
  [[nodiscard]] std::vector<T> get() const {
    std::vector<T> numbers(count_);
    executor_->copy_out(numbers.data(), numbers_, count_);
    return numbers;
  }
  [[nodiscard]] T get(std::size_t k) const {
    T number;
    executor_->copy_out(&number, numbers_ + k, 1);
    return number;
  }

 private:
  Executor* executor_ = nullptr;
  T* numbers_ = nullptr;
  std::size_t count_ = 0, capacity_ = 0;
};

}  // namespace thawslide::exec
