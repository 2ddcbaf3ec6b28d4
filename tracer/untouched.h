// Vectors whose new elements are as the memory is: for arrays that a parallel loop fills at once.
// Otherwise one thread would write to every page first, and that takes a good part of a fast build.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace tracer {

template <class Value>
struct UntouchedAllocator : std::allocator<Value> {
  static_assert(std::is_trivially_copyable_v<Value> && std::is_trivially_destructible_v<Value>);
  template <class Other>
  struct rebind {
    using other = UntouchedAllocator<Other>;
  };
  template <class Other>
  void construct(Other*) noexcept {}
  template <class Other, class... Arguments>
  void construct(Other* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
};

template <class Value>
using UntouchedVector = std::vector<Value, UntouchedAllocator<Value>>;

}  // namespace tracer
