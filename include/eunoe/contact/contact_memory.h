#ifndef eunoe_contact_contact_memory_h
#define eunoe_contact_contact_memory_h

#include <eunoe/contact/pair_block.h>
#include <eunoe/core/simd.h>

#include <boost/align/aligned_allocator.hpp>

#include <vector>

namespace eunoe {

/// What contacts remember: a pool of records of a few doubles, one for each living contact only,
/// so that candidates that do not touch cost no memory traffic.
class ContactMemory
{
public:
  static constexpr std::int32_t none = -1;

  /// Forgets everything and sets the number of doubles in a record.
  void clear(unsigned int n_history)
  {
    quads_per_record = (n_history + 3) / 4;
    quads.clear();
    free.clear();
    n_records = 0;
  }

  /// Makes room for a number of records at once.
  void reserve(std::size_t n) { quads.reserve(n * quads_per_record); }

  /// A record of zeros.
  std::int32_t create()
  {
    if (!free.empty()) {
      const std::int32_t record = free.back();
      free.pop_back();
      for (unsigned int q = 0; q < quads_per_record; ++q)
        quads[record * quads_per_record + q] = Quad();
      return record;
    }
    quads.resize(quads.size() + quads_per_record);
    return n_records++;
  }

  void release(std::int32_t record) { free.push_back(record); }

  std::size_t n_living() const { return static_cast<std::size_t>(n_records) - free.size(); }

  /// Gives the room back of records that all have been released.
  void give_back()
  {
    quads = {};
    free = {};
    n_records = 0;
  }

  double *operator[](std::int32_t record) { return &quads[record * quads_per_record].x; }
  const double *operator[](std::int32_t record) const
  {
    return &quads[record * quads_per_record].x;
  }

  /// Copies records to the lanes of a block.
  EUNOE_ALWAYS_INLINE void load(PairBlock &block, const std::int32_t *records) const
  {
    for (unsigned int q = 0; q < quads_per_record; ++q)
      for (unsigned int k = 0; k < PairBlock::size; k += 4) {
        simd::Four v[4];
        for (unsigned int l = 0; l < 4; ++l)
          v[l] = simd::four(quads[records[k + l] * quads_per_record + q]);
        simd::transpose(v[0], v[1], v[2], v[3]);
        for (unsigned int l = 0; l < 4; ++l)
          simd::four(block.history[4 * q + l] + k) = v[l];
      }
  }

  /// Copies the lanes of a block to their records.
  EUNOE_ALWAYS_INLINE void store(const PairBlock &block, const std::int32_t *records)
  {
    for (unsigned int q = 0; q < quads_per_record; ++q)
      for (unsigned int k = 0; k < block.n; k += 4) {
        simd::Four v[4];
        for (unsigned int l = 0; l < 4; ++l)
          v[l] = simd::four(block.history[4 * q + l] + k);
        simd::transpose(v[0], v[1], v[2], v[3]);
        for (unsigned int l = 0; l < 4; ++l)
          simd::four(quads[records[k + l] * quads_per_record + q]) = v[l];
      }
  }

private:
  unsigned int quads_per_record = 0;
  std::int32_t n_records = 0;
  std::vector<Quad, boost::alignment::aligned_allocator<Quad, 64>> quads;
  std::vector<std::int32_t> free;
};

} // namespace eunoe

#endif
