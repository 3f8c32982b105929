#include <eunoe/core/declare.h>
#include <eunoe/core/random.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>

namespace eunoe {
namespace {

/// What the input gives, one value per particle (SI units).
struct Lists
{
  std::vector<double> x, y, z, vx, vy, vz, wx, wy, wz, diameters;
};

/// Particles written into the input one by one, all of type 0, in a single event.
class List : public Insertion
{
public:
  List(const Lists &lists, const PhysicalProperties &physics, MPI_Comm comm)
      : p(lists), type(physics.types[0]), sizes(type.sizes.make()), comm(comm)
  {
  }

  double largest_diameter() const override
  {
    double largest = p.diameters.empty() ? sizes->largest() : 0.;
    for (const double diameter : p.diameters)
      largest = std::max(largest, diameter > 0. ? diameter : sizes->largest());
    return largest;
  }

  bool gives_particles() const override { return true; }

  std::size_t supply(std::size_t) const override { return p.x.size(); }

  std::vector<Vec3> known_places() const override
  {
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < p.x.size(); ++k)
      places.push_back({p.x[k], p.y[k], p.z[k]});
    return places;
  }

  std::vector<std::vector<NewParticle>> known_events() const override { return {particles(1)}; }

  void skip(std::size_t n_events, std::size_t) override { done = n_events > 0; }

  bool finished() const override { return done; }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    done = true;
    return particles(ids.take(p.x.size()));
  }

private:
  /// This rank's share of all.
  std::vector<NewParticle> particles(const ParticleId first) const
  {
    const auto value = [](const std::vector<double> &list, std::size_t k) {
      return list.empty() ? 0. : list[list.size() == 1 ? 0 : k];
    };
    const auto [begin, end] = share_of(p.x.size(), comm);
    std::vector<NewParticle> share;
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle particle;
      particle.id = first + static_cast<ParticleId>(k);
      const double wanted = value(p.diameters, k);
      const double diameter =
          wanted > 0. ? wanted : sizes->diameter(uniform(type.sizes.seed, Draw::size, particle.id));
      particle.radius = 0.5 * diameter;
      particle.mass = sphere_mass(particle.radius, type.density);
      particle.position = {p.x[k], p.y[k], p.z[k]};
      particle.velocity = {value(p.vx, k), value(p.vy, k), value(p.vz, k)};
      particle.spin = {value(p.wx, k), value(p.wy, k), value(p.wz, k)};
      share.push_back(particle);
    }
    return share;
  }

  const Lists p;
  const ParticleType type;
  const std::unique_ptr<SizeDistribution> sizes;
  MPI_Comm comm;
  bool done = false;
};

class ListSection : public InsertionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    const std::pair<std::string, std::vector<double> *> entries[] = {
        {"list x", &lists.x},           {"list y", &lists.y},
        {"list z", &lists.z},           {"list velocity x", &lists.vx},
        {"list velocity y", &lists.vy}, {"list velocity z", &lists.vz},
        {"list omega x", &lists.wx},    {"list omega y", &lists.wy},
        {"list omega z", &lists.wz},    {"list diameters", &lists.diameters}};
    for (const auto &[name, values] : entries)
      declare::list(prm, name, *values, {},
                    "list: one value a particle (SI units)" +
                        std::string(name.size() > 6 ? ", or one for all; empty: 0, or the type's "
                                                      "sizes."
                                                    : "."));
  }

  void check(const InsertionSettings &, const ParameterCheck &check) const override
  {
    const ParameterCheck::Path section = {InsertionParameters::section};
    const std::vector<double> *const others[] = {&lists.y,  &lists.z,  &lists.vx,
                                                 &lists.vy, &lists.vz, &lists.wx,
                                                 &lists.wy, &lists.wz, &lists.diameters};
    check.require(!lists.x.empty(), section, "list x", "is empty.",
                  "Give the coordinates of at least one particle.");
    for (std::size_t k = 0; k < std::size(others); ++k)
      check.require(others[k]->size() == lists.x.size() || (k >= 2 && others[k]->size() <= 1),
                    section, "list x",
                    "has " + std::to_string(lists.x.size()) + " values, another list " +
                        std::to_string(others[k]->size()) + ".",
                    "Give one value a particle in every list.");
  }

  std::unique_ptr<Insertion> make(const InsertionSettings &, const PhysicalProperties &physics,
                                  MPI_Comm comm) const override
  {
    return std::make_unique<List>(lists, physics, comm);
  }

private:
  Lists lists;
};

const InsertionRegistry::Registration registration(insertion_methods(), "list",
                                                   [] { return std::make_unique<ListSection>(); });

} // namespace
} // namespace eunoe
