// Pixels of a texture or sky. Copies share them: a posed scene costs no pictures.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

namespace tracer {

// Reads like a const vector.
template <class Texel>
class Texels {
 public:
  using value_type = Texel;
  using const_iterator = typename std::vector<Texel>::const_iterator;

  Texels() = default;
  Texels(std::vector<Texel> texels)  // NOLINT(google-explicit-constructor): a vector becomes one
      : texels_(std::make_shared<const std::vector<Texel>>(std::move(texels))) {}

  size_t size() const { return texels_ ? texels_->size() : 0; }
  bool empty() const { return size() == 0; }
  const Texel* data() const { return texels_ ? texels_->data() : nullptr; }
  const Texel& operator[](size_t i) const { return (*texels_)[i]; }
  const_iterator begin() const { return texels_ ? texels_->begin() : const_iterator(); }
  const_iterator end() const { return texels_ ? texels_->end() : const_iterator(); }

  friend bool operator==(const Texels& a, const Texels& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::shared_ptr<const std::vector<Texel>> texels_;
};

}  // namespace tracer
