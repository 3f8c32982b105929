#include <eunoe/core/declare.h>
#include <eunoe/state/material_property.h>
#include <eunoe/state/new_particle.h>
#include <eunoe/state/physical_properties.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <limits>

namespace eunoe {

namespace {

const std::string section = "lagrangian physical properties";

std::string type_section(unsigned int t)
{
  return "particle type " + std::to_string(t);
}

std::string wall_section(std::size_t k)
{
  return "wall material " + std::to_string(k);
}

/// A property that several laws read: a member of Material.
struct SharedProperty
{
  SharedProperty(const std::string &name, double Material::*member, double largest,
                 const std::string &documentation)
      : registration(material_entries(), name, [=] {
          return MaterialEntry{MaterialEntry::Owner::particles_and_walls, 0., largest,
                               documentation,
                               [member](Material &m) -> double & { return m.*member; }};
        })
  {
  }

  const MaterialEntryRegistry::Registration registration;
};

constexpr double any = std::numeric_limits<double>::max();
const SharedProperty shared_properties[] = {
    {"young modulus", &Material::young_modulus, any, "Young's modulus (Pa)."},
    {"poisson ratio", &Material::poisson_ratio, 0.5, "Poisson's ratio."},
    {"restitution coefficient", &Material::restitution, 1.,
     "Restitution coefficient; a pair takes the harmonic mean."},
    {"friction coefficient", &Material::friction, any,
     "Sliding friction coefficient; a pair takes the harmonic mean."},
    {"rolling friction", &Material::rolling_friction, any,
     "Rolling friction coefficient; a pair takes the harmonic mean."},
    {"rolling viscous damping", &Material::rolling_viscous_damping, any,
     "Damping ratio of the EPSD rolling spring; a pair takes the harmonic mean."},
    {"surface energy", &Material::surface_energy, any,
     "Surface energy (J/m2); a pair takes twice the geometric mean."},
    {"hamaker constant", &Material::hamaker_constant, any,
     "Hamaker constant (J); a pair takes the arithmetic mean."}};

/// The properties of a wall, by name.
std::map<std::string, MaterialEntry> wall_properties()
{
  std::map<std::string, MaterialEntry> properties = material_entries().make_all();
  for (auto p = properties.begin(); p != properties.end();)
    p = p->second.owner == MaterialEntry::Owner::particles ? properties.erase(p) : std::next(p);
  return properties;
}

/// The entries of a material; @p of is "particles" or "wall".
void declare_material(dealii::ParameterHandler &prm, Material &m, const std::string &of)
{
  for (const auto &[name, p] : of == "wall" ? wall_properties() : material_entries().make_all())
    declare::between(prm, name + " " + of, p.value(m), p.smallest, p.largest, p.documentation);
}

/// The same entries of a material that takes those which it lacks from the common one of walls.
void declare_wall_material(dealii::ParameterHandler &prm, WallMaterial &material)
{
  declare::entry(prm, "surfaces", material.surfaces,
                 "Names of the walls and solids of this material, separated by commas: 'boundary "
                 "2', 'floating wall 0', 'solid object 1', or those of a process, such as "
                 "'spreader', 'measuring plate' or 'disc'. A name without a number means all "
                 "that have one.");
  for (const auto &[name, p] : wall_properties())
    declare::number_or_word(prm, name + " wall", "common", "common", p.smallest, p.largest,
                            p.documentation + " 'common': that of all other walls.",
                            [&material, name = name](const std::optional<double> &value) {
                              material.own.erase(name);
                              if (value)
                                material.own[name] = *value;
                            });
}

void check_material(const ParameterCheck &check, const ParameterCheck::Path &path,
                    const Material &m, const std::string &of)
{
  check.require(m.young_modulus > 0., path, "young modulus " + of,
                "is " + format(m.young_modulus) + " Pa.", "Give a positive modulus.");
}

} // namespace

MaterialEntryRegistry &material_entries()
{
  static MaterialEntryRegistry registry("property of materials");
  return registry;
}

Materials PhysicalProperties::materials() const
{
  std::vector<Material> all;
  for (const ParticleType &type : types)
    all.push_back(type.material);
  const auto n_types = static_cast<int>(all.size());
  all.push_back(wall);
  for (const WallMaterial &material : wall_materials) {
    all.push_back(wall);
    for (const auto &[name, value] : material.own)
      material_entries().make(name).value(all.back()) = value;
  }
  all.insert(all.end(), other_walls.begin(), other_walls.end());
  return Materials(all, n_types);
}

double PhysicalProperties::rayleigh_time(const double radius, const double density,
                                         const Material &material)
{
  const double nu = material.poisson_ratio;
  const double shear_modulus = material.young_modulus / (2. * (1. + nu));
  return M_PI * radius * std::sqrt(density / shear_modulus) / (0.1631 * nu + 0.8766);
}

std::vector<std::size_t> PhysicalProperties::types_in_use() const
{
  const bool all_alike = std::none_of(types.begin(), types.end(),
                                      [](const ParticleType &type) { return type.number > 0; });
  std::vector<std::size_t> used;
  for (std::size_t t = 0; t < types.size(); ++t)
    if (all_alike || types[t].number > 0)
      used.push_back(t);
  return used;
}

double PhysicalProperties::longest_time_step(const double share_of_rayleigh,
                                             const double share_of_contact,
                                             const NormalLaws &laws) const
{
  double longest = std::numeric_limits<double>::infinity();
  for (const std::size_t t : types_in_use()) {
    const ParticleType &type = types[t];
    const double radius = 0.5 * type.sizes.make()->smallest();
    longest =
        std::min({longest, share_of_rayleigh * rayleigh_time(radius, type.density, type.material),
                  share_of_contact * shortest_contact_time(type, radius, laws)});
  }
  return longest;
}

double PhysicalProperties::shortest_contact_time(const ParticleType &type, const double radius,
                                                 const NormalLaws &laws) const
{
  const double overlap = 0.01 * radius;
  const double mass = sphere_mass(radius, type.density);
  const double with_its_like =
      normal_stiffness(laws.pairs_are_linear, effective_young_modulus(type.material, type.material),
                       0.5 * radius, 0.5 * mass, overlap);
  double largest = with_its_like / (0.5 * mass);
  // With a partner that is much larger and heavier, like a wall, the effective radius and mass are
  // the particle's own.
  const Materials all = materials();
  for (int m = 0; m < all.size(); ++m)
    largest = std::max(
        largest,
        normal_stiffness(m < wall_material() ? laws.pairs_are_linear : laws.walls_are_linear,
                         effective_young_modulus(type.material, all[m]), radius, mass, overlap) /
            mass);
  return M_PI / std::sqrt(largest);
}

double PhysicalProperties::largest_diameter() const
{
  double largest = 0.;
  for (const ParticleType &type : types)
    largest = std::max(largest, type.sizes.make()->largest());
  return largest;
}

void PhysicalProperties::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::vector(prm, "g", gravity, "Acceleration of gravity (m/s2).");
  declare::number_of(prm, "number of particle types", types.size(), 1, 5,
                     "Number of the subsections 'particle type 0', 'particle type 1', ...");
  for (unsigned int t = 0; t < types.size(); ++t) {
    ParticleType &type = types[t];
    declare::enter(prm, type_section(t));
    type.sizes.declare(prm);
    declare::count(prm, "number of particles", type.number,
                   "Number of particles of this type to insert.");
    declare::alias(prm, "number of particles", "number");
    declare::not_negative(prm, "density particles", type.density, "Density (kg/m3).");
    declare_material(prm, type.material, "particles");
    declare::leave(prm);
  }
  declare_material(prm, wall, "wall");
  declare::number_of(
      prm, "number of wall materials", wall_materials.size(), 0, 20,
      "Number of the subsections 'wall material 0', ...: walls and solids that differ "
      "from the common ones.");
  for (std::size_t k = 0; k < wall_materials.size(); ++k) {
    declare::enter(prm, wall_section(k));
    declare_wall_material(prm, wall_materials[k]);
    declare::leave(prm);
  }
  declare::leave(prm);
}

void PhysicalProperties::read_files(const FileLoader &load)
{
  for (ParticleType &type : types)
    type.sizes.read_files(load);
}

void PhysicalProperties::check(const ParameterCheck &check) const
{
  check.advise(gravity.x != 0. || gravity.y != 0. || gravity.z != 0. ||
                   check.is_written({section}, "g"),
               {section}, "g", "is zero, so that nothing falls.",
               "Set it, to 0, 0, -9.81 for example, or write 0, 0, 0 if that is meant.");
  for (unsigned int t = 0; t < types.size(); ++t) {
    const ParameterCheck::Path path = {section, type_section(t)};
    types[t].sizes.check(check, path);
    check_material(check, path, types[t].material, "particles");
    check.require(types[t].density > 0., path, "density particles",
                  "is " + format(types[t].density) + " kg/m3.", "Give a positive density.");
  }
  check_material(check, {section}, wall, "wall");
  const Materials all = materials();
  for (std::size_t k = 0; k < wall_materials.size(); ++k) {
    check_material(check, {section, wall_section(k)}, all[wall_material(k)], "wall");
    check.require(!wall_materials[k].surfaces.empty(), {section, wall_section(k)}, "surfaces",
                  "is empty.", "Name the walls and solids that have this material.");
  }
}

} // namespace eunoe
