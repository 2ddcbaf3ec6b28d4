#include "app/window/priority.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

namespace app {

void lower_thread_priority(Priority to) {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &parameters);
  setpriority(PRIO_PROCESS, 0, static_cast<int>(to));  // Linux: of the calling thread alone
}

}  // namespace app
