#ifndef eunoe_contact_near_pairs_h
#define eunoe_contact_near_pairs_h

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace eunoe {

/// The places of those pairs of a list that can come within reach in the next steps. The others,
/// most of them where powder flows, are not looked at until the particles have gone far enough.
///
/// A list is good for as long as twice the largest steps of any particle add up to its margin. A
/// pair that is left out is out of reach, so forces are the same as of the whole list.
class NearPairs
{
public:
  /// Rounded steps may be longer than they should; pairs are near up to so much more of their
  /// reach.
  static constexpr double slack = 1e-6;

  /// To be called whenever the pairs have changed.
  void forget() { left = -1.; }

  /// Every particle has gone by at most @p step since the last call (m), infinite if that is not
  /// known.
  /// @param skin separation up to which the list has pairs (m)
  void note_step(const double step, const double skin)
  {
    // Looking at all of them once in n steps costs as much a step as looking at those that n steps
    // add to the margin.
    constexpr double share = 0.65, most_steps = 200.;
    left -= 2. * step;
    n_steps = std::isinf(step) ? 0. : std::min(most_steps, std::sqrt(share * skin / step));
    wanted = 2. * n_steps * step;
  }

  /// Whether it is worth while.
  bool is_used() const { return n_steps >= 2.; }
  bool is_due() const { return !(left >= 0.); }

  /// Begins a list.
  /// @return the separation up to which a pair belongs to it (m)
  double begin()
  {
    for (auto *list : {&places, &i, &j})
      list->clear();
    left = wanted;
    return wanted;
  }

  std::vector<std::int32_t> places; ///< ascending
  std::vector<std::int32_t> i, j;   ///< rows of the particles

private:
  double left = -1.;   ///< of the margin (m)
  double wanted = 0.;  ///< margin of the next list (m)
  double n_steps = 0.; ///< for which that will do
};

} // namespace eunoe

#endif
