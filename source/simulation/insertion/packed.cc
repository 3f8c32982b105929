#include <eunoe/core/exact_sum.h>
#include <eunoe/core/expressions.h>
#include <eunoe/core/problems.h>
#include <eunoe/domain/domain.h>
#include <eunoe/simulation/insertion.h>

#include "packing.h"

#include <algorithm>

namespace eunoe {
namespace {

/// Lethe's "packed": all particles at once, packed at random in a box without overlap.
class Packed : public Insertion
{
public:
  Packed(const InsertionSettings &settings, const PhysicalProperties &physics, MPI_Comm comm)
      : settings(settings), particles(physics.types), comm(comm)
  {
  }

  double largest_diameter() const override { return particles.largest_diameter(); }
  std::size_t supply(std::size_t) const override { return n_all; }
  void skip(std::size_t, std::size_t n_particles) override { particles.take(n_particles); }
  bool finished() const override { return particles.n_remaining() == 0; }

  void check(const Domain &domain, Problems &problems) const override
  {
    const Vec3 &low = settings.box_lower, &high = settings.box_upper;
    const std::string place =
        "subsection 'insertion info' / entry 'insertion box points coordinates':";
    bool has_room = true, is_inside = true;
    for (unsigned int d = 0; d < 3; ++d) {
      has_room = has_room && high[d] - low[d] >= largest_diameter();
      is_inside =
          is_inside && low[d] >= domain.lower()[d] - 1e-12 && high[d] <= domain.upper()[d] + 1e-12;
    }
    if (!is_inside)
      problems.add(place, "the box reaches out of the mesh.",
                   "Move the box inside, or enlarge the mesh.");
    if (!has_room && particles.n_remaining() > 0)
      problems.add(place,
                   "the box is narrower than the largest particle, of " +
                       format(largest_diameter()) + " m.",
                   "Enlarge the box.");
    constexpr double densest = 0.66;
    ExactSum volume;
    const auto [begin, end] = share_of(particles.n_remaining(), comm);
    for (std::size_t k = begin; k < end; ++k)
      volume +=
          sphere_mass(particles.particle(k, first_of_all + static_cast<ParticleId>(k)).radius, 1.);
    volume.reduce(comm);
    const double fraction =
        volume.value() / ((high.x - low.x) * (high.y - low.y) * (high.z - low.z));
    if (has_room && fraction > densest)
      problems.add(place,
                   "the particles would fill a share of " + format(fraction) + " of the box.",
                   "Enlarge the box, or insert fewer particles; random packings fill up to about "
                   "0.6.");
  }

  void survey(const Surroundings &surroundings) override
  {
    solids.clear();
    std::copy_if(surroundings.solids.begin(), surroundings.solids.end(), std::back_inserter(solids),
                 [&](const Solid &solid) { return solid.is_active(surroundings.time); });
    domain = &surroundings.domain;
    refuse_particles(surroundings);
    const PeriodicBox &box = surroundings.domain.periods();
    for (unsigned int d = 0; d < 3; ++d) {
      const double tolerance = 1e-9 * box.length[d];
      const bool spans =
          box.is_periodic(d) && std::abs(settings.box_lower[d] - box.origin[d]) <= tolerance &&
          std::abs(settings.box_upper[d] - settings.box_lower[d] - box.length[d]) <= tolerance;
      periods.length[d] = spans ? box.length[d] : 0.;
      periods.origin[d] = spans ? box.origin[d] : 0.;
    }
  }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    const std::size_t n = particles.n_remaining();
    std::vector<NewParticle> share;
    if (n == 0)
      return share;
    const ParticleId first = ids.take(n);
    // A wrong text has been refused when the parameters were checked.
    const Expressions acceptance(settings.acceptance, settings.acceptance_constants, 1);
    const bool takes_all = settings.acceptance == "1";
    Packing packing({settings.box_lower, settings.box_upper, periods,
                     [&](const Vec3 &x) { return takes_all ? 1. : acceptance.value(0, x, 0.); },
                     [this](const Vec3 &x) { return domain->contains(x); }},
                    solids, comm);
    const auto particle = [&](const ParticleId id) { return particles.particle(id - first, id); };
    for (const Packing::Sphere &sphere : packing.pack(
             [&](const ParticleId id) { return particle(id).radius; }, first, n, settings.seed))
    {
      share.push_back(particle(sphere.id));
      share.back().position = sphere.position;
      share.back().velocity = settings.velocity;
      share.back().spin = settings.spin;
    }
    particles.take(n);
    return share;
  }

private:
  /// What is packed does not know of particles that are there.
  void refuse_particles(const Surroundings &surroundings) const
  {
    const ParticleArrays &present = surroundings.particles;
    const Vec3 &low = settings.box_lower, &high = settings.box_upper;
    unsigned long long inside = 0;
    for (std::size_t row = 0; row < present.n_owned; ++row) {
      const Vec3 x = surroundings.domain.periods().wrap(present.position[row].vec());
      const double radius = present.radius(row);
      bool reaches_in = !surroundings.leaving[row];
      for (unsigned int d = 0; d < 3; ++d)
        reaches_in = reaches_in && x[d] > low[d] - radius && x[d] < high[d] + radius;
      inside += reaches_in ? 1 : 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &inside, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, comm);
    if (inside > 0 && particles.n_remaining() > 0)
      throw UserError("subsection 'insertion info': " + std::to_string(inside) +
                      " particles are where others are to be packed, and these would overlap "
                      "them. Move the box, empty it with a removal box, or insert by 'plane', "
                      "which looks for empty cells.");
  }

  static constexpr ParticleId first_of_all = 1;

  const InsertionSettings settings;
  ParticleSupply particles;
  const std::size_t n_all = particles.n_remaining(); ///< before the first event
  MPI_Comm comm;
  PeriodicBox periods;
  std::vector<Solid> solids; ///< those that act
  const Domain *domain = nullptr;
};

class PackedSection : public InsertionSection
{
public:
  void check(const InsertionSettings &settings, const ParameterCheck &check) const override
  {
    settings.check_box(check);
  }

  std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                  const PhysicalProperties &physics, MPI_Comm comm) const override
  {
    return std::make_unique<Packed>(settings, physics, comm);
  }
};

const InsertionRegistry::Registration registration(insertion_methods(), "packed", [] {
  return std::make_unique<PackedSection>();
});

} // namespace
} // namespace eunoe
