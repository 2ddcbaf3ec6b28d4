// Without Embree there is nobody to measure beside ours.
#include "app/peers/peers.h"

namespace app {

std::span<const tracer::PeerRow> peers() {
  return {};
}

std::string_view missing_peers() {
  return "Embree was not found when this was built, so nothing is measured beside ours.";
}

}  // namespace app
