#ifndef eunoe_state_material_property_h
#define eunoe_state_material_property_h

#include <eunoe/core/registry.h>
#include <eunoe/state/material.h>

#include <limits>

namespace eunoe {

/// What the input says of one property of materials: its entries have the registered name with
/// "particles" or "wall" behind it.
struct MaterialEntry
{
  enum class Owner
  {
    particles,
    particles_and_walls
  };

  Owner owner;
  double smallest, largest; ///< that the input may give
  std::string documentation;
  std::function<double &(Material &)> value;
};

using MaterialEntryRegistry = Registry<MaterialEntry>;
MaterialEntryRegistry &material_entries();

/// A property of materials that one law alone reads. A static object in the law's file is all that
/// it takes: the property has entries for every particle type, for walls, and for every wall
/// material.
class MaterialProperty
{
public:
  using Owner = MaterialEntry::Owner;

  struct Range
  {
    double smallest = -std::numeric_limits<double>::max();
    double largest = std::numeric_limits<double>::max();
  };

  /// @param standard if the input gives none
  MaterialProperty(const std::string &name, Owner owner, double standard, const Range &range,
                   const std::string &documentation)
      : name(name), standard(standard), registration(material_entries(), name, [=] {
          return MaterialEntry{owner, range.smallest, range.largest, documentation,
                               [name, standard](Material &material) -> double & {
                                 return material.added.try_emplace(name, standard).first->second;
                               }};
        })
  {
  }

  double operator()(const Material &material) const
  {
    const auto own = material.added.find(name);
    return own == material.added.end() ? standard : own->second;
  }

private:
  const std::string name;
  const double standard;
  const MaterialEntryRegistry::Registration registration;
};

} // namespace eunoe

#endif
