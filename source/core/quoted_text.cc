#include <eunoe/core/quoted_text.h>

#include <cstdint>
#include <cstdio>
#include <vector>

namespace eunoe {

const std::string byte_order_mark = "\xEF\xBB\xBF";

std::string shortened(const std::string &text, const std::size_t kept)
{
  // A slightly longer text stays whole: the note on its length would not be shorter.
  if (text.size() <= kept + 40)
    return text;
  std::size_t end = kept;
  // Not within a character of several bytes.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;
  return text.substr(0, end) + "... (" + std::to_string(text.size()) + " characters)";
}

namespace {

/// Characters of Unicode that are taken for others.
struct Lookalike
{
  std::uint32_t first, last;
  const char *name, *mend;
};

const std::vector<Lookalike> &lookalikes()
{
  const char *const blank = "Type a plain blank instead.", *const nothing = "Remove it.",
                    *const minus = "Type a plain '-' instead.",
                    *const quote = "Remove it: texts need no quotes.";
  static const std::vector<Lookalike> list = {
      {0x00A0, 0x00A0, "a no-break space", blank},
      {0x00AD, 0x00AD, "a soft hyphen", nothing},
      {0x2000, 0x200A, "a space of typography", blank},
      {0x200B, 0x200B, "a zero-width space", nothing},
      {0x200C, 0x200F, "an invisible mark", nothing},
      {0x2010, 0x2015, "a dash of typography", minus},
      {0x2018, 0x201F, "a quotation mark of typography", quote},
      {0x2028, 0x2029, "an invisible separator", "Type a plain line break instead."},
      {0x202A, 0x202E, "an invisible mark", nothing},
      {0x202F, 0x202F, "a narrow no-break space", blank},
      {0x205F, 0x205F, "a space of typography", blank},
      {0x2060, 0x2064, "an invisible mark", nothing},
      {0x2212, 0x2212, "a minus sign of typography", minus},
      {0x3000, 0x3000, "an ideographic space", blank},
      {0xFEFF, 0xFEFF, "a byte-order mark", nothing},
      {0xFF01, 0xFF5E, "a character of full width", "Type the plain one instead."}};
  return list;
}

/// The character that begins at @p at in UTF-8; @p at goes behind it.
std::uint32_t next_character(const std::string &text, std::size_t &at)
{
  const auto lead = static_cast<unsigned char>(text[at++]);
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  std::uint32_t code = more == 0 ? lead : lead & (0x3F >> more);
  for (int k = 0; k < more && at < text.size(); ++k)
    code = code << 6 | (static_cast<unsigned char>(text[at++]) & 0x3F);
  return code;
}

} // namespace

std::string advice_on_lookalikes(const std::string &text)
{
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t code = next_character(text, at);
    for (const Lookalike &l : lookalikes())
      if (code >= l.first && code <= l.last) {
        char number[16];
        std::snprintf(number, sizeof number, "U+%04X", code);
        return "It holds " + std::string(l.name) + " (" + number + "). " + l.mend;
      }
  }
  return "";
}

} // namespace eunoe
