#ifndef eunoe_contact_pair_list_h
#define eunoe_contact_pair_list_h

#include <eunoe/contact/near_pairs.h>
#include <eunoe/contact/pair_memory.h>
#include <eunoe/state/remaining.h>

#include <cstdint>
#include <vector>

namespace eunoe {

/// Pairs of particles that can touch before the next search, with what their contacts remember.
///
/// `i` and `j` are rows of ParticleArrays with id[i] < id[j]; at least one is owned. The order is
/// that of (contact-grid cell, id) of the pair's first and then second particle, which does not
/// depend on the distribution over ranks; so every particle sums its forces in the same order
/// everywhere.
struct PairList
{
  std::vector<std::int32_t> i, j;
  /// Record of the contact in `memory`, ContactMemory::none while the pair is out of reach.
  std::vector<std::int32_t> record;
  /// Oriented from i to j.
  PairMemory memory;
  /// Whether some pairs are of two sleepers; `awake` are the places of all others, ascending.
  bool some_sleep = false;
  std::vector<std::int32_t> awake;
  /// Of all, or of those that are awake.
  NearPairs near;

  std::size_t size() const { return i.size(); }

  void clear(unsigned int n_history)
  {
    clear_pairs();
    memory.clear(n_history);
  }

  /// Keeps the memory.
  void clear_pairs()
  {
    i.clear();
    j.clear();
    record.clear();
    some_sleep = false;
    awake.clear();
    near.forget();
  }

  /// Moves the pairs out; the memory stays.
  PairList take_pairs()
  {
    PairList taken;
    taken.i.swap(i);
    taken.j.swap(j);
    taken.record.swap(record);
    clear_pairs();
    return taken;
  }

  /// Lets the contacts of some particles end.
  /// @param leaves a flag for each row
  template <typename Flags>
  void end_contacts(const Flags &leaves)
  {
    for (std::size_t k = 0; k < size(); ++k)
      if (record[k] != ContactMemory::none && (leaves[i[k]] || leaves[j[k]])) {
        memory.release(record[k]);
        record[k] = ContactMemory::none;
      }
  }

  /// Gives the particles their new rows, of which those that were taken out have no pairs.
  void leave_out(const Remaining &remaining)
  {
    for (auto *rows : {&i, &j})
      for (std::int32_t &row : *rows)
        row = remaining[row];
  }

  /// Gives back room beyond a tenth more than there is, which vectors take when they grow.
  void trim()
  {
    for (auto *list : {&i, &j, &record})
      if (list->capacity() > list->size() + list->size() / 4) {
        std::vector<std::int32_t> copy;
        copy.reserve(list->size() + list->size() / 10);
        copy.assign(list->begin(), list->end());
        list->swap(copy);
      }
  }

  void reserve(const std::size_t n)
  {
    for (auto *list : {&i, &j, &record})
      list->reserve(n);
  }

  /// Appends @p n pairs, out of reach as yet.
  void append(const std::int32_t *first, const std::int32_t *second, const std::size_t n)
  {
    i.insert(i.end(), first, first + n);
    j.insert(j.end(), second, second + n);
    record.insert(record.end(), n, ContactMemory::none);
  }

  /// Appends pairs of another list of the same particles with their records: [begin, end).
  void append(const PairList &other, const std::size_t begin, const std::size_t end)
  {
    const auto copy = [&](std::vector<std::int32_t> &to, const std::vector<std::int32_t> &from) {
      to.insert(to.end(), from.begin() + begin, from.begin() + end);
    };
    copy(i, other.i);
    copy(j, other.j);
    copy(record, other.record);
  }

  /// Moves what the contacts remember to where it is needed for a new list of near pairs.
  void lay_out_memory();

  /// Lets contacts of near pairs begin, with a memory of zeros, and end.
  /// @param block of near pairs
  /// @param bits of those within reach
  void note_reach(std::size_t block, std::uint64_t bits);

private:
  /// Moves memory to the lanes of a new list of near pairs within the lanes, where none is in the
  /// pool and all pairs with a contact are near.
  void shift_lanes();
  /// @param but_near whether the records of near pairs stay where they are
  void move_memory_to_pool(bool but_near);
};

} // namespace eunoe

#endif
