#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

namespace lockstep {

/// An array for streaming: zero at first, at the start of a cache line, on pages of its own. Arrays
/// start at different offsets in their pages, so that those of one sweep do not compete for the
/// same cache sets.
template <typename Value>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(std::size_t n) : n_(n) {
    constexpr std::size_t line = 64, small_page = 4096, large_page = 2 << 20, step = 37 * line;
    static std::size_t n_made = 0;
    const std::size_t offset = (n_made++ * step) % (16 * small_page);
    const std::size_t page = n * sizeof(Value) > 2 * large_page ? large_page : small_page;
    const std::size_t bytes = (n * sizeof(Value) + offset + page - 1) / page * page;
    memory_.reset(static_cast<char*>(std::aligned_alloc(page, bytes)));
    if (!memory_)
      throw std::bad_alloc();
    if (page == large_page)
      madvise(memory_.get(), bytes, MADV_HUGEPAGE);
    std::memset(memory_.get(), 0, bytes);
    values_ = reinterpret_cast<Value*>(memory_.get() + offset);
  }

  std::size_t size() const { return n_; }
  Value* data() { return values_; }
  const Value* data() const { return values_; }
  Value& operator[](std::ptrdiff_t i) { return values_[i]; }
  const Value& operator[](std::ptrdiff_t i) const { return values_[i]; }

 private:
  struct Free {
    void operator()(char* memory) const { std::free(memory); }
  };
  std::size_t n_ = 0;
  std::unique_ptr<char, Free> memory_;
  Value* values_ = nullptr;
};

}  // namespace lockstep
