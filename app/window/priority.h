// Scheduling priority of threads.
#pragma once

namespace app {

// The calling thread gets only the processor time that others leave: batch scheduling and nice 10.
// Threads that it starts inherit this. There is no way back without privileges. Does nothing where
// the system refuses.
void lower_thread_priority();

}  // namespace app
