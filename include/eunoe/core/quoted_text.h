#ifndef eunoe_core_quoted_text_h
#define eunoe_core_quoted_text_h

#include <string>

namespace eunoe {

/// A piece of the input as a message quotes it: of one much longer than @p kept characters the
/// beginning and its length.
std::string shortened(const std::string &text, std::size_t kept = 60);

/// What a text begins with if it is a byte-order mark of UTF-8, which editors leave unseen.
extern const std::string byte_order_mark;

/// A sentence on the first character that is invisible or only looks like an ordinary one, such as
/// a no-break space; empty if the text has no such character.
std::string advice_on_lookalikes(const std::string &text);

} // namespace eunoe

#endif
