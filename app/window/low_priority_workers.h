// Lowers the priority of the TBB workers that help a thread of low priority.
#pragma once

#include <tbb/task_scheduler_observer.h>

#include "app/window/priority.h"

namespace app {

// Of the thread that makes it. Workers are shared by all arenas of the process and can never be
// raised again, so nothing that the window waits for may need them.
class LowPriorityWorkers : public tbb::task_scheduler_observer {
 public:
  LowPriorityWorkers() { observe(true); }
  ~LowPriorityWorkers() override { observe(false); }
  void on_scheduler_entry(bool) override { lower_thread_priority(Priority::tracing); }
};

}  // namespace app
