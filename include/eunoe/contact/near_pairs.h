#ifndef eunoe_contact_near_pairs_h
#define eunoe_contact_near_pairs_h

#include <eunoe/contact/pair_block.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace eunoe {

/// Those pairs of a list that can come within reach in the next steps, in whose order forces are
/// computed. The others, most of them where powder flows, are not looked at until the particles
/// have gone far enough.
///
/// Each particle has a pace, the step that it is expected to make at most while a list lasts: its
/// present one, or a typical one if that is longer. So few grains that fall fast do not make the
/// lists of all others long. A list has the pairs that can come within reach in so many paces of
/// both, and is good until the largest steps, over the pace of the particle that made them, add up
/// to as many. A pair that is left out is out of reach, so forces are the same as of the whole
/// list.
class NearPairs
{
public:
  /// Rounded steps may be longer than they should; pairs are near up to so much more of their
  /// reach.
  static constexpr double slack = 1e-6;

  /// To be called whenever the pairs have changed.
  void forget()
  {
    left = -1.;
    is_of_other_pairs = true;
  }

  /// Every particle has gone by at most @p paces of its own since the last call, infinite if that
  /// is not known.
  /// @param typical step (m)
  /// @param skin separation up to which the list has pairs (m)
  /// @param share see `share`; the same on all ranks, so that they make their lists at the same
  ///              steps and none waits for another's
  void note_step(const double paces, const double typical, const double skin, const double share)
  {
    constexpr double most_steps = 200.;
    left -= paces;
    const bool is_known = std::isfinite(typical);
    slowest = std::max(is_known ? typical : 0., share * skin / (most_steps * most_steps));
    wanted = is_known ? std::floor(std::sqrt(share * skin / slowest)) : 0.;
  }

  /// Of a particle, by its present step (m).
  double pace(const double step) const { return std::max(step, slowest); }

  bool is_due() const { return !(left >= 0.); }

  /// Whether so many of the pairs are within reach that it costs less to compute all than to sort
  /// them out.
  bool is_dense() const { return dense; }

  /// Looking at all pairs once in n steps costs as much a step as what n steps add to the margin if
  /// n^2 is this share of skin over pace.
  double share() const { return dense ? share_if_dense : share_if_not; }

  /// Begins a list.
  /// @return the paces of both particles up to whose sum a pair belongs to it
  double begin()
  {
    judge_density();
    left = wanted;
    return wanted;
  }

  /// Room for @p n pairs in all.
  void make_room(const std::size_t n)
  {
    if (places.size() >= n)
      return;
    places.resize(n + n / 2);
    for (auto *list : {&i, &j})
      list->resize(n + n / 2);
  }

  /// Ends a list of @p n pairs: fills the last block with copies of the last pair.
  void end(const std::size_t n)
  {
    n_pairs = n;
    const std::size_t n_blocks = (n + PairBlock::size - 1) / PairBlock::size;
    make_room(n_blocks * PairBlock::size);
    for (std::size_t k = n; k < n_blocks * PairBlock::size; ++k) {
      i[k] = i[n - 1];
      j[k] = j[n - 1];
    }
    in_reach.assign(n_blocks, 0);
  }

  std::size_t size() const { return n_pairs; }
  /// Bits of the pairs of a block, which fill all but the last.
  std::uint64_t mask(const std::size_t block) const
  {
    constexpr std::size_t n_bits = std::numeric_limits<std::uint64_t>::digits;
    static_assert(PairBlock::size <= n_bits, "a block has a bit for each pair");
    const std::size_t n = std::min<std::size_t>(PairBlock::size, n_pairs - block * PairBlock::size);
    return ~std::uint64_t(0) >> (n_bits - n);
  }
  std::size_t n_blocks() const { return in_reach.size(); }

  /// @name There may be room for more behind the last pair, and its block
  ///@{
  std::vector<std::int32_t> places; ///< in the list of pairs, ascending
  std::vector<std::uint32_t> i, j;  ///< offsets of the particles' rows (bytes); whole blocks
  ///@}
  std::vector<std::int32_t> kind; ///< of the materials; whole blocks, empty if all have one
  /// Bits of those that were within reach when the last forces were computed, by block.
  std::vector<std::uint64_t> in_reach;
  /// Whether the pairs have changed since the last list.
  bool is_of_other_pairs = true;

private:
  /// From how many pairs of the last list were within reach.
  void judge_density()
  {
    // Of the first list nothing is known.
    if (n_pairs == 0)
      return;
    std::size_t n_within = 0;
    for (const std::uint64_t bits : in_reach)
      n_within += static_cast<std::size_t>(__builtin_popcountll(bits));
    // Of a dense list the margin is narrower.
    const double others = static_cast<double>(n_pairs - n_within) *
                          (dense ? 1. : std::sqrt(share_if_dense / share_if_not));
    // A change costs as much as some steps.
    dense = others < (dense ? 0.6 : 0.35) * static_cast<double>(n_within);
  }

  static constexpr double share_if_dense = 0.2, share_if_not = 0.65;

  bool dense = true;
  std::size_t n_pairs = 0;
  double left = -1.;   ///< of the paces
  double wanted = 0.;  ///< paces of the next list
  double slowest = 1.; ///< pace (m)
};

} // namespace eunoe

#endif
