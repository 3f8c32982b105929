#include <eunoe/contact/pair_list.h>

#include <algorithm>

namespace eunoe {

void PairList::move_memory_to_pool(const bool but_near)
{
  std::size_t next = 0;
  for (std::size_t k = 0; k < size(); ++k)
    if (but_near && next < near.size() && near.places[next] == static_cast<std::int32_t>(k))
      ++next;
    else if (record[k] != ContactMemory::none && PairMemory::is_in_lanes(record[k]))
      record[k] = memory.move_to_pool(record[k]);
}

void PairList::shift_lanes()
{
  // Near pairs are in the order of the list, so no contact overtakes another: those that go down do
  // so from the first on, those that go up from the last on, and none lands on one that has yet to
  // go.
  ContactLanes &lanes = memory.lanes;
  lanes.resize(std::max(near.size(), lanes.size()));
  const auto shift = [&](const std::size_t lane, const bool down) {
    std::int32_t &one = record[near.places[lane]];
    const auto to = static_cast<std::int32_t>(lane);
    if (one == ContactMemory::none || (down ? one <= to : one >= to))
      return;
    lanes.move(one, lane);
    one = to;
  };
  for (std::size_t lane = 0; lane < near.size(); ++lane)
    shift(lane, true);
  for (std::size_t lane = near.size(); lane-- > 0;)
    shift(lane, false);
  lanes.resize(near.size());
}

void PairList::lay_out_memory()
{
  const bool dense = near.is_dense();
  if (dense && !near.is_of_other_pairs && !memory.lanes.empty() && !memory.has_pooled())
    shift_lanes();
  else if (dense || !memory.lanes.empty()) {
    memory.begin_move(dense ? near.size() : 0);
    // Pairs that are near no more are those of a list that is new, or whose particles sleep now.
    if (!dense || near.is_of_other_pairs)
      move_memory_to_pool(dense);
    if (dense)
      for (std::size_t lane = 0; lane < near.size(); ++lane)
        if (std::int32_t &one = record[near.places[lane]]; one != ContactMemory::none) {
          memory.move_to_lane(one, lane);
          one = static_cast<std::int32_t>(lane);
        }
    memory.end_move();
  }
  // Contacts begin anywhere in the pool; in order, memory streams.
  if (!dense && near.is_of_other_pairs)
    memory.sort_pool(record);
  near.is_of_other_pairs = false;
  for (std::size_t place = 0; place < near.size(); ++place)
    near.in_reach[place / PairBlock::size] |=
        static_cast<std::uint64_t>(record[near.places[place]] != ContactMemory::none)
        << place % PairBlock::size;
}

void PairList::note_reach(const std::size_t block, std::uint64_t bits)
{
  bits &= near.mask(block);
  for (std::uint64_t changed = bits ^ near.in_reach[block]; changed != 0; changed &= changed - 1) {
    const std::size_t place =
        block * PairBlock::size + static_cast<std::size_t>(__builtin_ctzll(changed));
    std::int32_t &one = record[near.places[place]];
    if ((bits >> place % PairBlock::size & 1) == 0) {
      memory.release(one);
      one = ContactMemory::none;
    } else if (near.is_dense()) {
      one = static_cast<std::int32_t>(place);
      memory.lanes.clear(place);
    } else
      one = memory.create();
  }
  near.in_reach[block] = bits;
}

} // namespace eunoe
