#ifndef eunoe_state_physical_properties_h
#define eunoe_state_physical_properties_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/vec3.h>
#include <eunoe/state/material.h>
#include <eunoe/state/size_distribution.h>

#include <map>
#include <string>
#include <vector>

namespace eunoe {

/// `particle type i` of the input: a material with a density and a size distribution.
struct ParticleType
{
  Material material;
  double density = 1000.;
  unsigned int number = 0;
  SizeDistributionParameters sizes;
};

/// `wall material i` of the input: what distinguishes some walls and solids from the common ones.
struct WallMaterial
{
  std::string surfaces;              ///< their names, separated by commas
  std::map<std::string, double> own; ///< properties that differ, by name
};

/// `subsection lagrangian physical properties`.
struct PhysicalProperties : public ParameterSection
{
  Vec3 gravity;
  std::vector<ParticleType> types;
  Material wall;
  std::vector<WallMaterial> wall_materials;
  /// Materials of walls that differ, which a process may add: rows behind all others.
  std::vector<Material> other_walls;

  explicit PhysicalProperties(unsigned int n_types = 1, unsigned int n_wall_materials = 0)
      : types(n_types), wall_materials(n_wall_materials)
  {
  }

  /// Materials of the particle types, then the common one of walls and solids, then their own ones.
  Materials materials() const;
  /// Largest diameter that the types' size distributions give (m).
  double largest_diameter() const;
  int wall_material() const { return static_cast<int>(types.size()); }
  /// Number of the material that the input gives to `wall material` @p k.
  int wall_material(std::size_t k) const { return wall_material() + 1 + static_cast<int>(k); }

  /// Rayleigh time pi R sqrt(rho/G) / (0.1631 nu + 0.8766) of a particle (s).
  static double rayleigh_time(double radius, double density, const Material &material);

  /// The types of which particles are inserted. A process counts its particles itself: then all.
  std::vector<std::size_t> types_in_use() const;

  /// The time step that is these shares of the shortest Rayleigh time and of the stiffest contact's
  /// time, whichever is shorter (s).
  double longest_time_step(double share_of_rayleigh, double share_of_contact,
                           const NormalLaws &laws) const;

  /// Half period of the stiffest contact that a particle of a type can have at an overlap of one
  /// hundredth of its radius, with its like or with any material of the case (s).
  /// @param radius (m)
  double shortest_contact_time(const ParticleType &type, double radius,
                               const NormalLaws &laws) const;

  void declare(dealii::ParameterHandler &prm) override;
  /// Reads what the particle types have in files; collective if @p load is.
  void read_files(const FileLoader &load);
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
