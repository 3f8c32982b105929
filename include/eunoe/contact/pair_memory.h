#ifndef eunoe_contact_pair_memory_h
#define eunoe_contact_pair_memory_h

#include <eunoe/contact/contact_lanes.h>
#include <eunoe/contact/contact_memory.h>

#include <algorithm>
#include <utility>

namespace eunoe {

/// What the contacts of a list of pairs remember, found by the number of a record: in lanes, in
/// which the laws work where nearly all near pairs have a contact, or in a pool.
class PairMemory
{
public:
  void clear(const unsigned int n_history)
  {
    length = n_history;
    pool.clear(n_history);
    lanes.assign(0, n_history);
  }

  /// Makes room in the pool.
  void reserve(const std::size_t n) { pool.reserve(n); }

  /// A record of zeros in the pool.
  std::int32_t create() { return first_of_pool + pool.create(); }

  /// Of a contact that has ended.
  void release(const std::int32_t record)
  {
    if (!is_in_lanes(record))
      pool.release(record - first_of_pool);
  }

  static bool is_in_lanes(const std::int32_t record) { return record < first_of_pool; }
  static std::int32_t number_in_pool(const std::int32_t record) { return record - first_of_pool; }

  void read(const std::int32_t record, double *values) const
  {
    if (is_in_lanes(record))
      lanes.read(record, values);
    else
      std::copy_n(pool[record - first_of_pool], length, values);
  }

  /// Into a record of the pool.
  void write(const std::int32_t record, const double *values)
  {
    std::copy_n(values, length, pool[record - first_of_pool]);
  }

  /// Lays out the records of the pool in the order in which they stand in a list, whose other
  /// entries are none or in lanes; they get new numbers.
  void sort_pool(std::vector<std::int32_t> &records)
  {
    const std::size_t n = pool.n_living();
    ContactMemory sorted;
    sorted.clear(length);
    sorted.reserve(n + n / 5);
    for (std::int32_t &record : records)
      if (!is_in_lanes(record)) {
        const std::int32_t place = sorted.create();
        std::copy_n(pool[record - first_of_pool], length, sorted[place]);
        record = first_of_pool + place;
      }
    pool = std::move(sorted);
  }

  bool has_pooled() const { return pool.n_living() > 0; }

  /// Makes new lanes, of zeros; until `end_move` the old ones are still there, from which records
  /// can be moved.
  void begin_move(const std::size_t n_lanes)
  {
    std::swap(lanes, old_lanes);
    lanes.assign(n_lanes, length);
  }

  /// @param record as it was before the move
  void move_to_lane(const std::int32_t record, const std::size_t lane)
  {
    double values[PairBlock::max_history];
    if (is_in_lanes(record))
      old_lanes.read(record, values);
    else {
      std::copy_n(pool[record - first_of_pool], length, values);
      pool.release(record - first_of_pool);
    }
    lanes.write(lane, values);
  }

  /// @param record in the old lanes
  /// @return its number in the pool
  std::int32_t move_to_pool(const std::int32_t record)
  {
    const std::int32_t pooled = pool.create();
    old_lanes.read(record, pool[pooled]);
    return first_of_pool + pooled;
  }

  void end_move()
  {
    old_lanes = {};
    if (pool.n_living() == 0)
      pool.give_back();
  }

  ContactLanes lanes;
  ContactMemory pool;

private:
  /// Lanes have smaller numbers.
  static constexpr std::int32_t first_of_pool = 1 << 30;

  unsigned int length = 0;
  ContactLanes old_lanes;
};

} // namespace eunoe

#endif
