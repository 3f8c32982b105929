#ifndef eunoe_core_stop_request_h
#define eunoe_core_stop_request_h

namespace eunoe::stop_request {

/// From now on SIGTERM, SIGINT and SIGUSR1 are noted instead of ending the process. A second signal
/// of the same kind ends it.
void listen();

/// Number of the signal that has come to this process, 0 if none has.
int received();

} // namespace eunoe::stop_request

#endif
