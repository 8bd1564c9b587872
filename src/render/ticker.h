#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace turbid {

/// A thread that calls a function again and again with pauses, from construction to destruction (which waits for the
/// call that is under way).
class Ticker {
 public:
  Ticker(std::chrono::milliseconds pause, std::function<void()> tick)
      : thread_([this, pause, tick = std::move(tick)](const std::stop_token& stop) {
          std::unique_lock lock(mutex_);
          while (!wakeup_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) tick();
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any wakeup_;
  std::jthread thread_;
};

}  // namespace turbid
