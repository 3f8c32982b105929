#ifndef eunoe_core_sha256_h
#define eunoe_core_sha256_h

#include <iosfwd>
#include <string>

namespace eunoe {

/// SHA-256 of a text (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(const std::string &text);

/// The same of all that is left of a stream, of which only a small part is in memory at a time.
std::string sha256(std::istream &stream);

} // namespace eunoe

#endif
