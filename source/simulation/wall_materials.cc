#include <eunoe/core/quoted_text.h>
#include <eunoe/simulation/simulation.h>

#include <boost/algorithm/string.hpp>

#include <cctype>
#include <set>

namespace eunoe {

namespace {

/// Whether @p name is that of a solid, or that of a row of numbered ones without the number.
bool means(const std::string &name, const std::string &solid)
{
  const std::size_t n = name.size();
  return solid.compare(0, n, name) == 0 &&
         (solid.size() == n || (solid.size() > n + 1 && solid[n] == ' ' &&
                                std::isdigit(static_cast<unsigned char>(solid[n + 1])) != 0));
}

} // namespace

void give_materials(std::vector<Solid> &solids, const PhysicalProperties &physics,
                    Problems &problems)
{
  for (std::size_t k = 0; k < physics.wall_materials.size(); ++k) {
    const std::string place = "subsection 'lagrangian physical properties' / subsection 'wall "
                              "material " +
                              std::to_string(k) + "' / entry 'surfaces':";
    std::vector<std::string> names;
    boost::split(names, physics.wall_materials[k].surfaces, boost::is_any_of(","));
    // A boundary may have several sides of one name.
    std::set<std::string> reported;
    for (std::string &name : names) {
      boost::trim(name);
      bool found = false;
      for (Solid &solid : solids) {
        if (!means(name, solid.name))
          continue;
        found = true;
        if (solid.material != physics.wall_material() && reported.insert(solid.name).second)
          problems.add(place, "'" + solid.name + "' has a material already.",
                       "Name each wall or solid once.");
        solid.material = physics.wall_material(k);
      }
      std::string all;
      for (const Solid &solid : solids)
        all += (all.empty() ? "'" : ", '") + solid.name + "'";
      if (!found)
        problems.add(place, "there is no wall or solid '" + shortened(name) + "'.",
                     all.empty() ? "The case has none." : "Name some of " + all + ".");
    }
  }
}

} // namespace eunoe
