#include <eunoe/core/random.h>
#include <eunoe/particles/insertion.h>

#include <algorithm>

namespace eunoe {

std::size_t VolumeGrid::capacity() const
{
  std::size_t n = 1;
  for (unsigned int d = 0; d < 3; ++d)
    n *= static_cast<std::size_t>(std::max(0., std::floor((upper[d] - lower[d]) / pitch + 1e-9)));
  return n;
}

Vec3 VolumeGrid::point(std::size_t k, const unsigned int seed, const ParticleId id) const
{
  Vec3 x;
  for (const int d : order) {
    const auto n = static_cast<std::size_t>(std::floor((upper[d] - lower[d]) / pitch + 1e-9));
    const double slack = pitch - offset;
    x[d] = lower[d] + (k % n) * pitch + 0.5 * slack +
           offset * uniform(seed, Draw::offset, id, static_cast<std::uint32_t>(d));
    k /= n;
  }
  return x;
}

namespace {

/// Lethe's "volume": events that fill a grid of points in a box, one type after another.
class Volume : public Insertion
{
public:
  Volume(const InsertionParameters &parameters, const PhysicalProperties &physics)
      : parameters(parameters), types(physics.types)
  {
    double largest = 0.;
    for (const ParticleType &type : types) {
      sizes.push_back(type.sizes.make());
      largest = std::max(largest, sizes.back()->largest());
      remaining.push_back(type.number);
    }
    grid.lower = parameters.box_lower;
    grid.upper = parameters.box_upper;
    grid.pitch = parameters.distance_threshold * largest;
    grid.offset = parameters.maximum_offset * largest;
    grid.order = parameters.directions;
  }

  bool finished() const override
  {
    return std::all_of(remaining.begin(), remaining.end(), [](std::size_t n) { return n == 0; });
  }

  std::vector<NewParticle> next(ParticleId &next_id, MPI_Comm comm) override
  {
    const std::size_t room = grid.capacity();
    if (room == 0)
      throw UserError(
          "subsection 'insertion info' / entry 'insertion box points coordinates' gives "
          "a box without room for a single particle. Enlarge the box.");
    std::size_t type = 0;
    while (type < remaining.size() && remaining[type] == 0)
      ++type;
    if (type == remaining.size())
      return {};
    const std::size_t wanted = parameters.per_event > 0 ? parameters.per_event : remaining[type];
    const std::size_t n = std::min({wanted, remaining[type], room});
    if (parameters.frequency == 0 && n < std::min(wanted, remaining[type]))
      throw UserError(
          "subsection 'insertion info' / entry 'insertion box points coordinates' gives "
          "a box with room for " +
          std::to_string(room) + " particles, but " + std::to_string(remaining[type]) +
          " are to be inserted at once. Enlarge the box, or set an 'insertion "
          "frequency' for several events.");
    const auto [begin, end] = share_of(n, comm);
    std::vector<NewParticle> particles;
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle p;
      p.id = next_id + static_cast<ParticleId>(k);
      p.type = static_cast<int>(type);
      p.radius = 0.5 * sizes[type]->diameter(uniform(types[type].sizes.seed, Draw::size, p.id));
      p.mass = sphere_mass(p.radius, types[type].density);
      p.position = grid.point(k, parameters.seed, p.id);
      p.velocity = parameters.velocity;
      p.spin = parameters.spin;
      particles.push_back(p);
    }
    next_id += static_cast<ParticleId>(n);
    remaining[type] -= n;
    return particles;
  }

private:
  const InsertionParameters parameters;
  const std::vector<ParticleType> types;
  std::vector<std::unique_ptr<SizeDistribution>> sizes;
  std::vector<std::size_t> remaining;
  VolumeGrid grid;
};

const InsertionRegistry::Registration registration(insertion_methods(), "volume",
                                                   [](const InsertionParameters &parameters,
                                                      const PhysicalProperties &physics) {
                                                     return std::make_unique<Volume>(parameters,
                                                                                     physics);
                                                   });

} // namespace
} // namespace eunoe
