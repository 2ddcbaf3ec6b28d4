// What the program runs on.
#pragma once

#include <string>
#include <string_view>

namespace tracer {

std::string cpu_name();       // as the system calls it; "unknown" if it does not
int thread_count();           // that a parallel loop uses at most
std::string_view isa_name();  // the widest vector instructions that the processor has
std::string_view version();   // of bvhscope

}  // namespace tracer
