#ifndef eunoe_core_deal_ii_message_h
#define eunoe_core_deal_ii_message_h

#include <exception>
#include <string>

namespace eunoe {

/// What went wrong inside deal.II, without its stack trace.
std::string deal_ii_message(const std::exception &error);

} // namespace eunoe

#endif
