#ifndef eunoe_state_material_h
#define eunoe_state_material_h

#include <map>
#include <string>
#include <vector>

namespace eunoe {

/// Surface and bulk properties of a particle type or of a wall, SI units.
struct Material
{
  double young_modulus = 1e6;
  double poisson_ratio = 0.3;
  double restitution = 0.1;
  double friction = 0.1;
  double rolling_friction = 0.1;
  double rolling_viscous_damping = 0.1;
  double surface_energy = 0.;
  double hamaker_constant = 4e-19;
  /// Those that single laws read, by name, as far as they are given; see MaterialProperty.
  std::map<std::string, double> added = {};
};

/// Effective constants of a pair of materials (doc/physics.md, "Effective constants").
///@{
double effective_young_modulus(const Material &a, const Material &b);
double effective_shear_modulus(const Material &a, const Material &b);
double effective_surface_energy(const Material &a, const Material &b);
double effective_hamaker_constant(const Material &a, const Material &b);
/// Harmonic mean 2ab/(a+b), used for friction, rolling friction and restitution; 0 if both are 0.
double harmonic_mean(double a, double b);
/// -2 sqrt(5/6) beta with beta = ln e / sqrt(ln^2 e + pi^2) (Tsuji 1992); beta = -1 for e = 0.
double damping_factor(double restitution);
/// Stiffness of the linear law (N/m), see source/contact/laws/linear.cc.
double linear_stiffness(double effective_young_modulus, double effective_radius,
                        double effective_mass);
/// Stiffness 2 E* sqrt(R* overlap) of a Hertzian contact against further approach (N/m).
double hertz_tangent_stiffness(double effective_young_modulus, double effective_radius,
                               double overlap);
///@}

/// Whether contacts have a constant stiffness, which decides how short they are.
struct NormalLaws
{
  bool pairs_are_linear = false, walls_are_linear = false;
};

/// Stiffness of a contact against further approach (N/m).
inline double normal_stiffness(const bool is_linear, const double effective_young_modulus,
                               const double effective_radius, const double effective_mass,
                               const double overlap)
{
  return is_linear ? linear_stiffness(effective_young_modulus, effective_radius, effective_mass)
                   : hertz_tangent_stiffness(effective_young_modulus, effective_radius, overlap);
}

/// The materials of a simulation: particle types first, then those of walls and solids.
/// The pair (a, b) of a particle type and any material has row `kind(a, b)` in the laws' tables.
class Materials
{
public:
  Materials(std::vector<Material> materials, int n_particle_types)
      : materials(std::move(materials)), n_particle_types(n_particle_types)
  {
  }

  /// Row of all pairs of particles if they share one, else -1.
  int only_particle_kind() const { return n_particle_types == 1 ? kind(0, 0) : -1; }

  /// Number of particle types, whose materials come first.
  int n_types() const { return n_particle_types; }

  /// Whether a material is one of walls and solids.
  bool is_wall(int m) const { return m >= n_particle_types; }

  int size() const { return static_cast<int>(materials.size()); }
  int kind(int a, int b) const { return a * size() + b; }
  const Material &operator[](int m) const { return materials[m]; }

  /// The table with one row per kind, which `row(a, b)` computes from two materials.
  template <typename Row>
  auto table(const Row &row) const
  {
    std::vector<decltype(row(materials[0], materials[0]))> rows;
    rows.reserve(materials.size() * materials.size());
    for (const Material &a : materials)
      for (const Material &b : materials)
        rows.push_back(row(a, b));
    return rows;
  }

private:
  std::vector<Material> materials;
  int n_particle_types;
};

} // namespace eunoe

#endif
