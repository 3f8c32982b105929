// What is needed of a mesh of equal boxes without making its cells.

#include <eunoe/domain/mesh.h>

#include <cmath>
#include <sstream>

namespace eunoe {

namespace {

std::vector<std::string> parts_of(const std::string &arguments)
{
  std::vector<std::string> parts;
  std::istringstream stream(arguments);
  for (std::string part; std::getline(stream, part, ':');)
    parts.push_back(part);
  return parts;
}

/// How many whole numbers from 1, separated by commas; 0 if they are no such thing.
std::size_t n_counts(const std::string &text)
{
  std::size_t n = 0;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ','); ++n) {
    char *end;
    const double value = std::strtod(word.c_str(), &end);
    while (*end == ' ')
      ++end;
    if (*end != '\0' || !(value >= 1. && value < 2e9) || value != std::floor(value))
      return 0;
  }
  return n;
}

} // namespace

std::optional<MeshParameters> sketch_of(const MeshParameters &mesh)
{
  if (mesh.type != "dealii" || mesh.has_target || mesh.placement.angle != 0.)
    return std::nullopt;
  MeshParameters sketch = mesh;
  sketch.refinement = 0;
  if (mesh.grid_type == "hyper_rectangle" || mesh.grid_type == "hyper_cube")
    return sketch;
  const bool cube = mesh.grid_type == "subdivided_hyper_cube";
  std::vector<std::string> parts = parts_of(mesh.grid_arguments);
  if ((!cube && mesh.grid_type != "subdivided_hyper_rectangle") || parts.empty() ||
      n_counts(parts[0]) != (cube ? 1u : 3u))
    return std::nullopt;
  sketch.grid_arguments = cube ? "1" : "1, 1, 1";
  for (std::size_t k = 1; k < parts.size(); ++k)
    sketch.grid_arguments += ":" + parts[k];
  return sketch;
}

} // namespace eunoe
