// Waiting for what another thread does.
#pragma once

#include <chrono>
#include <thread>

// Whether the condition became true within a time that only a hanging program needs.
template <class Condition>
bool becomes_true(const Condition& condition,
                  std::chrono::seconds limit = std::chrono::seconds(240)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}
