#ifndef eunoe_core_sha256_h
#define eunoe_core_sha256_h

#include <string>

namespace eunoe {

/// SHA-256 of a text (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(const std::string &text);

} // namespace eunoe

#endif
