#ifndef eunoe_contact_contact_lanes_h
#define eunoe_contact_contact_lanes_h

#include <eunoe/contact/pair_block.h>

#include <boost/align/aligned_allocator.hpp>

#include <vector>

namespace eunoe {

/// What the contacts of a list of pairs remember, in blocks as the laws read and write them:
/// `[block][component][lane]`. Every pair has a lane, with zeros while it has no contact.
class ContactLanes
{
public:
  /// Makes a lane of zeros for each of @p n_pairs.
  void assign(const std::size_t n_pairs, const unsigned int n_history)
  {
    n_components = n_history;
    values.clear();
    // Room that is never used takes no memory, while a vector that grows is there twice.
    values.reserve((n_pairs + n_pairs / 2) * n_components);
    resize(n_pairs);
  }

  /// Changes the number of lanes; those that stay keep what they have.
  void resize(const std::size_t n_pairs)
  {
    const std::size_t n_blocks = (n_pairs + PairBlock::size - 1) / PairBlock::size;
    values.resize(n_blocks * PairBlock::size * n_components);
  }

  bool empty() const { return values.empty(); }

  /// Number of lanes, in whole blocks.
  std::size_t size() const { return n_components > 0 ? values.size() / n_components : 0; }

  PairBlock::Lanes *block(const std::size_t b)
  {
    return reinterpret_cast<PairBlock::Lanes *>(values.data() + b * PairBlock::size * n_components);
  }

  /// Lets the processor bring a block into its cache.
  void prefetch(const std::size_t b) const
  {
    const double *const begin = values.data() + b * PairBlock::size * n_components;
    for (std::size_t k = 0; k < PairBlock::size * n_components; k += 8)
      __builtin_prefetch(begin + k);
  }

  void read(const std::size_t lane, double *to) const
  {
    const double *const from = values.data() + place(lane);
    for (unsigned int h = 0; h < n_components; ++h)
      to[h] = from[h * PairBlock::size];
  }

  void write(const std::size_t lane, const double *from)
  {
    double *const to = values.data() + place(lane);
    for (unsigned int h = 0; h < n_components; ++h)
      to[h * PairBlock::size] = from[h];
  }

  void move(const std::size_t from_lane, const std::size_t to_lane)
  {
    const double *const from = values.data() + place(from_lane);
    double *const to = values.data() + place(to_lane);
    for (unsigned int h = 0; h < n_components; ++h)
      to[h * PairBlock::size] = from[h * PairBlock::size];
  }

  void clear(const std::size_t lane)
  {
    double *const to = values.data() + place(lane);
    for (unsigned int h = 0; h < n_components; ++h)
      to[h * PairBlock::size] = 0.;
  }

private:
  /// Of the first component.
  std::size_t place(const std::size_t lane) const
  {
    constexpr std::size_t size = PairBlock::size;
    return lane / size * size * n_components + lane % size;
  }

  unsigned int n_components = 0;
  std::vector<double, boost::alignment::aligned_allocator<double, 64>> values;
};

} // namespace eunoe

#endif
