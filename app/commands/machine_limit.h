// How much of the machine a command may use.
#pragma once

#include <optional>

#include <tbb/global_control.h>

#include "app/commands/scene_options.h"
#include "tracer/bvh/ray_kernels.h"

namespace app {

// Until the end of its life; what is not given: all that the machine has.
class MachineLimit {
 public:
  explicit MachineLimit(const SceneOptions& options) {
    if (options.threads) {
      threads_.emplace(tbb::global_control::max_allowed_parallelism, size_t(*options.threads));
    }
    tracer::prefer_isa(options.isa.value_or(""));
  }
  ~MachineLimit() { tracer::prefer_isa(""); }
  MachineLimit(const MachineLimit&) = delete;
  MachineLimit& operator=(const MachineLimit&) = delete;

 private:
  std::optional<tbb::global_control> threads_;
};

}  // namespace app
