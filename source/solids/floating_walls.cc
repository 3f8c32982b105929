#include <eunoe/core/declare.h>
#include <eunoe/solids/infinite_plane.h>
#include <eunoe/solids/solid_parameters.h>

namespace eunoe {

namespace {

const std::string section = "floating walls";

std::string wall_section(std::size_t k)
{
  return "wall " + std::to_string(k);
}

} // namespace

void FloatingWallParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::number_of(
      prm, "number of floating walls", walls.size(), 0, 50,
      "Number of the subsections 'wall 0', 'wall 1', ...: infinite planes, which keep "
      "each particle on its side.");
  for (std::size_t k = 0; k < walls.size(); ++k) {
    declare::enter(prm, wall_section(k));
    declare::vector(prm, "point on wall", walls[k].point, "A point of the plane (m).");
    declare::vector(prm, "normal vector", walls[k].normal,
                    "Direction perpendicular to the plane, of any length and either sign.");
    declare::entry(prm, "start time", walls[k].start, "The wall acts from here (s) ...");
    declare::entry(prm, "end time", walls[k].end, "... to here (s).");
    declare::leave(prm);
  }
  declare::leave(prm);
}

void FloatingWallParameters::check(const ParameterCheck &check) const
{
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const ParameterCheck::Path path = {section, wall_section(k)};
    check.require(norm(walls[k].normal) > 0., path, "normal vector", "is zero.",
                  "Give a direction perpendicular to the wall.");
    const std::string end = "is " + format(walls[k].end) + " s, not after the start time of " +
                            format(walls[k].start) + " s";
    const bool is_written = check.is_written(path, "end time");
    check.require(walls[k].start < walls[k].end || !is_written, path, "end time", end + ".",
                  "Give a later time.");
    check.advise(walls[k].start < walls[k].end || is_written, path, "end time",
                 end + ", so the wall does not act.", "Give a later time.");
  }
}

std::vector<Solid> FloatingWallParameters::make(const int material) const
{
  std::vector<Solid> solids;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    Solid solid;
    solid.name = "floating wall " + std::to_string(k);
    solid.shape = std::make_shared<InfinitePlane>(walls[k].point, walls[k].normal);
    solid.motion = std::make_shared<AtRest>();
    solid.material = material;
    solid.start = walls[k].start;
    solid.end = walls[k].end;
    solid.output = false;
    solids.push_back(solid);
  }
  return solids;
}

} // namespace eunoe
