#ifndef eunoe_contact_living_contacts_h
#define eunoe_contact_living_contacts_h

#include <eunoe/contact/pair_list.h>

#include <numeric>

namespace eunoe {

/// The contacts of a list of pairs by their first particles, so that a new list of the same
/// particles finds what they remember.
class LivingContacts
{
public:
  /// @param n_rows number of particles
  LivingContacts(const PairList &pairs, const std::size_t n_rows) : starts(n_rows + 1, 0)
  {
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (pairs.record[k] != ContactMemory::none)
        ++starts[pairs.i[k] + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    contacts.resize(starts.back());
    std::vector<std::int32_t> next(starts.begin(), starts.end() - 1);
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (pairs.record[k] != ContactMemory::none)
        contacts[next[pairs.i[k]]++] = {pairs.j[k], pairs.record[k]};
  }

  /// Gives the records to the same pairs of a new list, from @p begin on.
  void attach(PairList &pairs, const std::size_t begin) const
  {
    for (std::size_t k = begin; k < pairs.size(); ++k)
      for (std::int32_t c = starts[pairs.i[k]]; c < starts[pairs.i[k] + 1]; ++c)
        if (contacts[c].second == pairs.j[k])
          pairs.record[k] = contacts[c].record;
  }

private:
  struct Contact
  {
    std::int32_t second, record;
  };

  std::vector<std::int32_t> starts;
  std::vector<Contact> contacts;
};

} // namespace eunoe

#endif
