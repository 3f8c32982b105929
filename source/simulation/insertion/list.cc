#include <eunoe/core/random.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>

namespace eunoe {
namespace {

/// Particles written into the input one by one, all of type 0, in a single event.
class List : public Insertion
{
public:
  List(const InsertionParameters &parameters, const PhysicalProperties &physics, MPI_Comm comm)
      : p(parameters), type(physics.types[0]), sizes(type.sizes.make()), comm(comm)
  {
  }

  double largest_diameter() const override
  {
    double largest = p.list_diameters.empty() ? sizes->largest() : 0.;
    for (const double diameter : p.list_diameters)
      largest = std::max(largest, diameter > 0. ? diameter : sizes->largest());
    return largest;
  }

  std::size_t supply(std::size_t) const override { return p.list_x.size(); }

  std::vector<Vec3> known_places() const override
  {
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < p.list_x.size(); ++k)
      places.push_back({p.list_x[k], p.list_y[k], p.list_z[k]});
    return places;
  }

  std::vector<std::vector<NewParticle>> known_events() const override { return {particles(1)}; }

  void skip(std::size_t n_events, std::size_t) override { done = n_events > 0; }

  bool finished() const override { return done; }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    done = true;
    return particles(ids.take(p.list_x.size()));
  }

private:
  /// This rank's share of all.
  std::vector<NewParticle> particles(const ParticleId first) const
  {
    const auto value = [](const std::vector<double> &list, std::size_t k) {
      return list.empty() ? 0. : list[k];
    };
    const auto [begin, end] = share_of(p.list_x.size(), comm);
    std::vector<NewParticle> share;
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle particle;
      particle.id = first + static_cast<ParticleId>(k);
      const double diameter =
          p.list_diameters.empty() || p.list_diameters[k] <= 0.
              ? sizes->diameter(uniform(type.sizes.seed, Draw::size, particle.id))
              : p.list_diameters[k];
      particle.radius = 0.5 * diameter;
      particle.mass = sphere_mass(particle.radius, type.density);
      particle.position = {p.list_x[k], p.list_y[k], p.list_z[k]};
      particle.velocity = {value(p.list_vx, k), value(p.list_vy, k), value(p.list_vz, k)};
      particle.spin = {value(p.list_wx, k), value(p.list_wy, k), value(p.list_wz, k)};
      share.push_back(particle);
    }
    return share;
  }

  const InsertionParameters p;
  const ParticleType type;
  const std::unique_ptr<SizeDistribution> sizes;
  MPI_Comm comm;
  bool done = false;
};

const InsertionRegistry::Registration registration(
    insertion_methods(), "list",
    [](const InsertionParameters &parameters, const PhysicalProperties &physics, MPI_Comm comm) {
      return std::make_unique<List>(parameters, physics, comm);
    });

} // namespace
} // namespace eunoe
