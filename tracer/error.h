// The one exception for bad input.
#pragma once

#include <stdexcept>
#include <string>

namespace tracer {

// Thrown by file input and output only. The message says what, where ("file:line: ...") and what
// to do; it is shown to the user as it is.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tracer
