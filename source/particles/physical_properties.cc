#include <eunoe/core/declare.h>
#include <eunoe/particles/new_particle.h>
#include <eunoe/particles/physical_properties.h>

#include <algorithm>
#include <limits>

namespace eunoe {

namespace {

const std::string section = "lagrangian physical properties";

std::string type_section(unsigned int t)
{
  return "particle type " + std::to_string(t);
}

/// The entries of a material; @p of is "particles" or "wall".
void declare_material(dealii::ParameterHandler &prm, Material &m, const std::string &of)
{
  declare::positive(prm, "young modulus " + of, m.young_modulus, "Young's modulus (Pa).");
  prm.add_parameter("poisson ratio " + of, m.poisson_ratio, "Poisson's ratio.",
                    declare::Patterns::Double(0., 0.5));
  prm.add_parameter("restitution coefficient " + of, m.restitution,
                    "Restitution coefficient; a pair takes the harmonic mean.",
                    declare::Patterns::Double(0., 1.));
  declare::positive(prm, "friction coefficient " + of, m.friction,
                    "Sliding friction coefficient; a pair takes the harmonic mean.");
  declare::positive(prm, "rolling friction " + of, m.rolling_friction,
                    "Rolling friction coefficient; a pair takes the harmonic mean.");
  declare::positive(prm, "rolling viscous damping " + of, m.rolling_viscous_damping,
                    "Damping ratio of the EPSD rolling spring; a pair takes the harmonic mean.");
  declare::positive(prm, "surface energy " + of, m.surface_energy,
                    "Surface energy (J/m2); a pair takes twice the geometric mean.");
  declare::positive(prm, "hamaker constant " + of, m.hamaker_constant,
                    "Hamaker constant (J); a pair takes the arithmetic mean.");
}

void check_material(const ParameterCheck &check, const ParameterCheck::Path &path,
                    const Material &m, const std::string &of)
{
  check.require(m.young_modulus > 0., path, "young modulus " + of,
                "is " + format(m.young_modulus) + " Pa.", "Give a positive modulus.");
  check.require(m.poisson_ratio < 0.5, path, "poisson ratio " + of,
                "is " + format(m.poisson_ratio) + ".", "Give a value of at least 0 and below 0.5.");
}

} // namespace

Materials PhysicalProperties::materials() const
{
  std::vector<Material> all;
  for (const ParticleType &type : types)
    all.push_back(type.material);
  const auto n_types = static_cast<int>(all.size());
  all.push_back(wall);
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

double PhysicalProperties::shortest_contact_time(const ParticleType &type) const
{
  const double radius = 0.5 * type.sizes.make()->smallest(), overlap = 0.01 * radius;
  const double mass = sphere_mass(radius, type.density);
  const double with_its_like = hertz_tangent_stiffness(
      effective_young_modulus(type.material, type.material), 0.5 * radius, overlap);
  double largest = with_its_like / (0.5 * mass);
  // A partner that is much larger and heavier, like a wall, lends the particle its own radius and
  // mass.
  const Materials all = materials();
  for (int m = 0; m < all.size(); ++m)
    largest =
        std::max(largest, hertz_tangent_stiffness(effective_young_modulus(type.material, all[m]),
                                                  radius, overlap) /
                              mass);
  return M_PI / std::sqrt(largest);
}

double PhysicalProperties::smallest_diameter() const
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const ParticleType &type : types)
    smallest = std::min(smallest, type.sizes.make()->smallest());
  return smallest;
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
  prm.enter_subsection(section);
  declare::vector(prm, "g", gravity, "Acceleration of gravity (m/s2).");
  prm.declare_entry("number of particle types", std::to_string(types.size()),
                    declare::Patterns::Integer(1, 5),
                    "Number of the subsections 'particle type 0', 'particle type 1', ...");
  for (unsigned int t = 0; t < types.size(); ++t) {
    ParticleType &type = types[t];
    prm.enter_subsection(type_section(t));
    type.sizes.declare(prm);
    declare::count(prm, "number of particles", type.number,
                   "Number of particles of this type to insert.");
    prm.declare_alias("number of particles", "number");
    declare::positive(prm, "density particles", type.density, "Density (kg/m3).");
    declare_material(prm, type.material, "particles");
    prm.add_parameter("surface charge density particles", type.material.surface_charge,
                      "Charge of a particle over its surface (C/m2), of either sign; see 'model "
                      "parameters / electrostatic charge'.");
    prm.leave_subsection();
  }
  declare_material(prm, wall, "wall");
  declare::positive(prm, "dynamic viscosity gas", gas_viscosity,
                    "Dynamic viscosity of the still gas around the particles (Pa s); 0: no drag.");
  declare::positive(prm, "density gas", gas_density,
                    "Density of that gas (kg/m3). 0: Stokes's drag; else that of Schiller and "
                    "Naumann.");
  prm.leave_subsection();
}

void PhysicalProperties::check(const ParameterCheck &check) const
{
  for (unsigned int t = 0; t < types.size(); ++t) {
    const ParameterCheck::Path path = {section, type_section(t)};
    types[t].sizes.check(check, path);
    check_material(check, path, types[t].material, "particles");
    check.require(types[t].density > 0., path, "density particles",
                  "is " + format(types[t].density) + " kg/m3.", "Give a positive density.");
  }
  check_material(check, {section}, wall, "wall");
}

} // namespace eunoe
