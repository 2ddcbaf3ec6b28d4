// Scheduling priority of threads.
#pragma once

namespace app {

// For threads beside the window's own: the painter's pictures come before more rays.
enum class Priority { painting = 7, tracing = 10 };  // as nice values

// The calling thread gives way to threads of higher priority, and gets their processor time only
// where they leave it. Threads that it starts inherit this. There is no way back without
// privileges. Does nothing where the system refuses.
void lower_thread_priority(Priority to);

}  // namespace app
