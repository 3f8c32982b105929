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

/// Whole numbers from 1, separated by commas; empty for any other text.
std::vector<unsigned int> counts_in(const std::string &text)
{
  std::vector<unsigned int> counts;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    char *end;
    const double value = std::strtod(word.c_str(), &end);
    while (*end == ' ')
      ++end;
    if (*end != '\0' || !(value >= 1. && value < 2e9) || value != std::floor(value))
      return {};
    counts.push_back(static_cast<unsigned int>(value));
  }
  return counts;
}

} // namespace

std::optional<BoxSketch> sketch_of(const MeshParameters &mesh)
{
  if (mesh.type != "dealii" || mesh.has_target || mesh.placement.angle != 0.)
    return std::nullopt;
  BoxSketch sketch = {mesh, {1., 1., 1.}};
  sketch.mesh.refinement = 0;
  const double cuts = std::pow(2., mesh.refinement);
  for (double &n : sketch.n_cells)
    n *= cuts;
  if (mesh.grid_type == "hyper_rectangle" || mesh.grid_type == "hyper_cube")
    return sketch;
  const bool cube = mesh.grid_type == "subdivided_hyper_cube";
  std::vector<std::string> parts = parts_of(mesh.grid_arguments);
  const std::vector<unsigned int> counts =
      parts.empty() ? std::vector<unsigned int>() : counts_in(parts[0]);
  if ((!cube && mesh.grid_type != "subdivided_hyper_rectangle") ||
      counts.size() != (cube ? 1u : 3u))
    return std::nullopt;
  for (unsigned int d = 0; d < 3; ++d)
    sketch.n_cells[d] *= counts[cube ? 0 : d];
  sketch.mesh.grid_arguments = cube ? "1" : "1, 1, 1";
  for (std::size_t k = 1; k < parts.size(); ++k)
    sketch.mesh.grid_arguments += ":" + parts[k];
  return sketch;
}

} // namespace eunoe
