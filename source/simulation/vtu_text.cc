#include "vtu_text.h"

#include <deal.II/base/utilities.h>

#include <stdexcept>
#include <zlib.h>

namespace eunoe {

namespace {

template <typename Number>
std::string in_base64(const Number *values, const std::size_t n)
{
  const auto *const bytes = reinterpret_cast<const unsigned char *>(values);
  return dealii::Utilities::encode_base64(
      std::vector<unsigned char>(bytes, bytes + n * sizeof(Number)));
}

/// An array as VTK compresses it: number of blocks, their size, the last one's size and the
/// compressed size, then one block.
std::string compressed(const std::vector<std::int64_t> &values)
{
  const auto size = static_cast<uLong>(values.size() * sizeof(std::int64_t));
  uLongf compressed_size = compressBound(size);
  std::vector<unsigned char> bytes(compressed_size);
  if (compress2(bytes.data(), &compressed_size,
                reinterpret_cast<const unsigned char *>(values.data()), size, Z_BEST_SPEED) != Z_OK)
    throw std::runtime_error("zlib cannot compress a picture");
  const std::uint32_t counts[] = {1, static_cast<std::uint32_t>(size),
                                  static_cast<std::uint32_t>(size),
                                  static_cast<std::uint32_t>(compressed_size)};
  return in_base64(counts, std::size(counts)) + in_base64(bytes.data(), compressed_size);
}

} // namespace

VtuText::VtuText(const std::string &text)
{
  const std::string end = "</Piece>\n";
  const std::size_t first = text.find("<Piece"), last = text.rfind(end);
  if (first == std::string::npos || last == std::string::npos)
    throw std::logic_error("a .vtu file without a piece");
  head = text.substr(0, first);
  piece = text.substr(first, last + end.size() - first);
  tail = text.substr(last + end.size());
}

bool VtuText::has_points() const
{
  return piece.find("NumberOfPoints=\"0\"") == std::string::npos;
}

void VtuText::add(const PictureIntegers &integers)
{
  const std::size_t data = piece.find("<PointData");
  if (!has_points() || data == std::string::npos)
    return;
  piece.insert(piece.find('\n', data) + 1,
               "    <DataArray type=\"Int64\" Name=\"" + integers.name + "\" format=\"binary\">\n" +
                   compressed(integers.values) + "\n    </DataArray>\n");
}

} // namespace eunoe
