// Work beside the session, as panels see it: they ask for it through Requests, and find in the
// frame what is known of it.
#pragma once

#include <memory>
#include <string>

namespace ui {

template <class Result>
struct Background {
  std::shared_ptr<const Result> result;  // the newest, of a part while it runs; nullptr: none yet
  bool running = false;                  // or waiting for its turn
  bool stopped = false;                  // before it was complete
  float fraction = 0.0f;                 // of the work, 0..1
  std::string doing;                     // in words
  std::string error;                     // one sentence if it failed
};

}  // namespace ui
