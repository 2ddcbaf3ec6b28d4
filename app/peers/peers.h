// The ray tracers that were found when this was built, to be measured beside ours.
#pragma once

#include <span>
#include <string_view>

#include "tracer/analyze/peer.h"

namespace app {

std::span<const tracer::PeerRow> peers();

// One sentence about what is missing; "" if nothing is.
std::string_view missing_peers();

}  // namespace app
