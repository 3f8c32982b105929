#ifndef eunoe_state_remaining_h
#define eunoe_state_remaining_h

#include <cstdint>
#include <vector>

namespace eunoe {

/// The rows of particles after some have been taken out: the others close up in their order.
class Remaining
{
public:
  static constexpr std::int32_t none = -1;

  /// @param leaves a flag for each row
  template <typename Flags>
  explicit Remaining(const Flags &leaves) : rows(leaves.size())
  {
    std::int32_t next = 0;
    for (std::size_t row = 0; row < leaves.size(); ++row)
      rows[row] = leaves[row] ? none : next++;
  }

  /// New row of a particle, none if it has been taken out.
  std::int32_t operator[](const std::size_t row) const { return rows[row]; }

  /// Leaves out what belongs to those that were taken out.
  /// @param by_row of all rows, or of the first ones
  template <typename Entry>
  void keep(std::vector<Entry> &by_row) const
  {
    std::size_t n = 0;
    for (std::size_t row = 0; row < by_row.size(); ++row)
      if (rows[row] != none)
        by_row[n++] = std::move(by_row[row]);
    by_row.resize(n);
  }

  /// Gives a list of rows their new numbers, without those that were taken out.
  void renumber(std::vector<std::int32_t> &list) const
  {
    std::size_t n = 0;
    for (const std::int32_t row : list)
      if (rows[row] != none)
        list[n++] = rows[row];
    list.resize(n);
  }

private:
  std::vector<std::int32_t> rows;
};

} // namespace eunoe

#endif
