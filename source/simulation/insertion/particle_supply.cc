#include <eunoe/core/random.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>
#include <numeric>

namespace eunoe {

ParticleSupply::ParticleSupply(const std::vector<ParticleType> &types) : types(types)
{
  for (const ParticleType &type : types) {
    sizes.push_back(type.sizes.make());
    largest = std::max(largest, sizes.back()->largest());
    remaining.push_back(type.number);
  }
}

std::size_t ParticleSupply::n_remaining() const
{
  return std::accumulate(remaining.begin(), remaining.end(), std::size_t(0));
}

NewParticle ParticleSupply::particle(std::size_t k, const ParticleId id) const
{
  std::size_t type = 0;
  for (; k >= remaining[type]; ++type)
    k -= remaining[type];
  NewParticle p;
  p.id = id;
  p.type = static_cast<int>(type);
  p.radius = 0.5 * sizes[type]->diameter(uniform(types[type].sizes.seed, Draw::size, id));
  p.mass = sphere_mass(p.radius, types[type].density);
  return p;
}

void ParticleSupply::take(std::size_t n)
{
  for (std::size_t &left : remaining) {
    const std::size_t now = std::min(left, n);
    left -= now;
    n -= now;
  }
}

} // namespace eunoe
