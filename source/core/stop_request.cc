#include <eunoe/core/stop_request.h>

#include <csignal>
#include <initializer_list>

namespace eunoe::stop_request {

namespace {

volatile std::sig_atomic_t last_signal = 0;

extern "C" void note(int number)
{
  last_signal = number;
}

} // namespace

void listen()
{
  last_signal = 0;
  struct sigaction action = {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (const int number : {SIGTERM, SIGINT, SIGUSR1})
    sigaction(number, &action, nullptr);
}

int received()
{
  return last_signal;
}

} // namespace eunoe::stop_request
