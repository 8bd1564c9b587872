#include "render/signals.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>

namespace turbid {
namespace {

// Handlers may do little more than store to lock-free atomics.
std::atomic<int> g_interrupts{0};
std::atomic<bool> g_image_request{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, kSignals.size()> g_old_actions;

void on_signal(int signal) {
  if (signal == SIGHUP)
    g_image_request.store(true);
  else if (g_interrupts.fetch_add(1) > 0)
    ::_exit(130);
}

}  // namespace

SignalGuard::SignalGuard() {
  g_interrupts = 0;
  g_image_request = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &g_old_actions[i]);
    if (kSignals[i] != SIGINT || g_old_actions[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

SignalGuard::~SignalGuard() {
  for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &g_old_actions[i], nullptr);
}

bool SignalGuard::interrupted() const { return g_interrupts.load() > 0; }
bool SignalGuard::take_image_request() { return g_image_request.exchange(false); }

}  // namespace turbid
