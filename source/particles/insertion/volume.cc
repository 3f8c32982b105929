#include <eunoe/core/random.h>
#include <eunoe/particles/insertion.h>

#include <algorithm>
#include <numeric>

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
  Volume(const InsertionParameters &parameters, const PhysicalProperties &physics, MPI_Comm comm)
      : parameters(parameters), types(physics.types), comm(comm)
  {
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

    const std::size_t room = grid.capacity(), wanted = n_remaining();
    const std::string box =
        "subsection 'insertion info' / entry 'insertion box points coordinates' gives a box with "
        "room for " +
        std::to_string(room) + " particles, but ";
    if (wanted > 0 && room == 0)
      throw UserError(box + "there are particles to insert. Enlarge the box.");
    if (parameters.frequency == 0 && room < of_next_event())
      throw UserError(box + std::to_string(of_next_event()) +
                      " are to be inserted at once. Enlarge the box, or set an 'insertion "
                      "frequency' for several events.");
    if (parameters.frequency == 0 && of_next_event() < wanted)
      throw UserError(
          "subsection 'insertion info' / entry 'inserted number of particles at each time step' "
          "is " +
          std::to_string(parameters.per_event) + ", but all " + std::to_string(wanted) +
          " particles come in a single event, as the 'insertion frequency' is 0. Set it to 0 for "
          "all at once, or set an 'insertion frequency'.");
  }

  double largest_diameter() const override { return largest; }

  std::size_t supply(const std::size_t n_events) const override
  {
    return std::min(n_remaining(), n_events * std::min(of_next_event(), grid.capacity()));
  }

  void skip(std::size_t n_events) override { take(supply(n_events)); }

  bool finished() const override { return n_remaining() == 0; }

  std::vector<NewParticle> next(ParticleId &next_id) override
  {
    const std::size_t n = std::min(of_next_event(), grid.capacity());
    const auto [begin, end] = share_of(n, comm);
    std::vector<NewParticle> particles;
    std::size_t type = 0, last_of_type = remaining[0];
    for (std::size_t k = 0; k < end; ++k) {
      while (k == last_of_type)
        last_of_type += remaining[++type];
      if (k < begin)
        continue;
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
    take(n);
    return particles;
  }

private:
  std::size_t n_remaining() const
  {
    return std::accumulate(remaining.begin(), remaining.end(), std::size_t(0));
  }
  void take(std::size_t n)
  {
    for (std::size_t &left : remaining) {
      const std::size_t now = std::min(left, n);
      left -= now;
      n -= now;
    }
  }
  std::size_t of_next_event() const
  {
    return parameters.per_event > 0 ? std::min<std::size_t>(parameters.per_event, n_remaining())
                                    : n_remaining();
  }

  const InsertionParameters parameters;
  const std::vector<ParticleType> types;
  MPI_Comm comm;
  double largest = 0.;
  std::vector<std::unique_ptr<SizeDistribution>> sizes;
  std::vector<std::size_t> remaining; ///< of each type
  VolumeGrid grid;
};

const InsertionRegistry::Registration registration(
    insertion_methods(), "volume",
    [](const InsertionParameters &parameters, const PhysicalProperties &physics, MPI_Comm comm) {
      return std::make_unique<Volume>(parameters, physics, comm);
    });

} // namespace
} // namespace eunoe
