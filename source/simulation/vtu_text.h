#ifndef eunoe_source_simulation_vtu_text_h
#define eunoe_source_simulation_vtu_text_h

#include <eunoe/simulation/output.h>

#include <string>

namespace eunoe {

/// The text of a .vtu file as deal.II writes it, in parts: that of one rank is a piece between a
/// head and a tail that all ranks share.
struct VtuText
{
  explicit VtuText(const std::string &text);

  /// Adds integers to the points of the piece.
  void add(const PictureIntegers &integers);
  bool has_points() const;

  std::string head, piece, tail;
};

} // namespace eunoe

#endif
