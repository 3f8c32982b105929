#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/expressions.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/random.h>
#include <eunoe/domain/domain.h>
#include <eunoe/simulation/insertion.h>

#include "obstacles.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace eunoe {
namespace {

/// Spheres that overlap in a box, pushed apart and out of solids until none does.
///
/// Their overlaps are springs, whose energy falls to zero by FIRE (Bitzek, Koskinen, Gaehler,
/// Moseler, Gumbsch 2006), in steps of a pseudo-time. Every rank knows all spheres and computes the
/// forces on its share of them, each summed in the order of the pairs; so the result is the same on
/// any number of ranks.
class Packing
{
public:
  /// @param acceptance positive at places where a centre may be
  /// @param holds whether a place is in the mesh
  Packing(const Vec3 &lower, const Vec3 &upper, const PeriodicBox &box,
          std::function<double(const Vec3 &)> acceptance, std::function<bool(const Vec3 &)> holds,
          const std::vector<Solid> &solids, MPI_Comm comm)
      : lower(lower), upper(upper), box(box), acceptance(std::move(acceptance)),
        holds(std::move(holds)), obstacles(solids), comm(comm)
  {
  }

  /// Centres (m) of spheres, from random ones. Throws a UserError if no place or no packing is
  /// found.
  std::vector<Vec3> pack(const std::vector<double> &radii, unsigned int seed, ParticleId first_id);

private:
  /// Share by which all are larger than they are while they are pushed, so that they do not even
  /// touch in the end.
  static constexpr double margin = 1e-3;
  static constexpr unsigned int most_steps = 20000;

  void scatter(unsigned int seed, ParticleId first_id);
  void find_neighbours();
  /// Forces on all spheres (m), with springs of unit stiffness.
  /// @return largest overlap over the sum of the radii, of all
  double compute_forces();
  void move(double time_step);
  /// Back into the box, where there is no period.
  Vec3 inside(Vec3 x, double radius) const;
  /// The place where a move ends: its aim, or the nearest place that is accepted, or its beginning.
  Vec3 accepted(const Vec3 &from, Vec3 to, double radius) const;

  const Vec3 lower, upper;
  const PeriodicBox box;
  const std::function<double(const Vec3 &)> acceptance;
  const std::function<bool(const Vec3 &)> holds;
  Obstacles obstacles;
  MPI_Comm comm;
  double largest = 0.; ///< radius (m)
  std::vector<double> radius;
  std::vector<Vec3> position, searched, velocity, force;
  std::size_t begin = 0, end = 0;                    ///< this rank's share
  std::vector<std::vector<std::int32_t>> neighbours; ///< of that share
};

Vec3 Packing::inside(Vec3 x, const double r) const
{
  x = box.wrap(x);
  for (unsigned int d = 0; d < 3; ++d)
    if (!box.is_periodic(d))
      x[d] = std::min(std::max(x[d], lower[d] + r), upper[d] - r);
  return x;
}

Vec3 Packing::accepted(const Vec3 &from, Vec3 to, const double r) const
{
  const double h = 1e-3 * largest;
  // Newton's method along the gradient, and a little further.
  for (unsigned int tries = 0; tries < 5; ++tries) {
    const double value = acceptance(to);
    if (value > 0.)
      return holds(to) ? to : from;
    Vec3 gradient;
    for (unsigned int d = 0; d < 3; ++d) {
      Vec3 shift;
      shift[d] = h;
      gradient[d] = (acceptance(to + shift) - acceptance(to - shift)) / (2. * h);
    }
    const double steepness = norm(gradient);
    if (!(steepness > 0.))
      return from;
    to = inside(to + (1e-2 * h + 1.001 * -value / steepness) / steepness * gradient, r);
  }
  return from;
}

void Packing::scatter(const unsigned int seed, const ParticleId first_id)
{
  constexpr std::uint32_t most_tries = 100000;
  for (std::size_t k = 0; k < radius.size(); ++k) {
    for (std::uint32_t t = 0;; ++t) {
      if (t == most_tries)
        throw UserError("subsection 'insertion info' / subsection 'insertion acceptance function': "
                        "hardly any place of the insertion box is in the mesh and has a positive "
                        "value. Correct the expression, or move the box.");
      Vec3 x;
      for (unsigned int d = 0; d < 3; ++d)
        x[d] = lower[d] +
               (upper[d] - lower[d]) * uniform(seed, Draw::packing, first_id + k, 3 * t + d);
      position[k] = inside(x, radius[k]);
      if (acceptance(position[k]) > 0. && holds(position[k]))
        break;
    }
  }
}

void Packing::find_neighbours()
{
  const double skin = 0.3 * largest, reach = 2. * largest * (1. + margin) + skin;
  const ContactGrid grid(lower, upper, box, reach);
  std::vector<std::uint64_t> keys(position.size());
  for (std::size_t k = 0; k < position.size(); ++k)
    keys[k] = grid.key(position[k]);
  std::vector<std::int32_t> order(position.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  });
  ParticleArrays spheres;
  spheres.resize(position.size(), 0, 0);
  for (std::size_t row = 0; row < order.size(); ++row) {
    const Vec3 &x = position[order[row]];
    spheres.position[row] = {x.x, x.y, x.z, (1. + margin) * radius[order[row]]};
    spheres.id[row] = static_cast<ParticleId>(order[row]);
  }
  PairList pairs;
  pairs.clear(0);
  grid.find_pairs(spheres, skin, pairs);
  neighbours.assign(end - begin, {});
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto i = static_cast<std::size_t>(order[pairs.i[p]]);
    const auto j = static_cast<std::size_t>(order[pairs.j[p]]);
    if (i >= begin && i < end)
      neighbours[i - begin].push_back(static_cast<std::int32_t>(j));
    if (j >= begin && j < end)
      neighbours[j - begin].push_back(static_cast<std::int32_t>(i));
  }
  obstacles.search(position, radius, begin, end, margin * largest + skin);
  searched = position;
}

double Packing::compute_forces()
{
  double worst = 0.;
  for (std::size_t k = begin; k < end; ++k) {
    Vec3 sum;
    for (const std::int32_t n : neighbours[k - begin]) {
      const Vec3 away = box.shortest(position[k] - position[n]);
      const double touch = (1. + margin) * (radius[k] + radius[n]), distance = norm(away);
      if (distance >= touch)
        continue;
      worst = std::max(worst, (touch - distance) / (radius[k] + radius[n]));
      // Two spheres at the same place separate along an axis, the first one downwards.
      sum += distance > 0. ? (touch / distance - 1.) * away
                           : Vec3{0., 0., (static_cast<std::int32_t>(k) < n ? -1. : 1.) * touch};
    }
    double depth = 0.;
    sum += obstacles.push(k - begin, position[k], (1. + margin) * radius[k], depth);
    worst = std::max(worst, depth / radius[k]);
    force[k] = sum;
  }
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, comm);
  int size;
  MPI_Comm_size(comm, &size);
  std::vector<int> counts(size), starts(size);
  for (int r = 0; r < size; ++r) {
    starts[r] = static_cast<int>(3 * (force.size() * r / size));
    counts[r] = static_cast<int>(3 * (force.size() * (r + 1) / size)) - starts[r];
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, force.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, comm);
  return worst;
}

void Packing::move(const double time_step)
{
  double moved2 = 0.;
  for (std::size_t k = 0; k < position.size(); ++k) {
    const Vec3 aim = inside(position[k] + time_step * velocity[k], radius[k]);
    const Vec3 x = accepted(position[k], aim, radius[k]);
    if (x != aim)
      velocity[k] = 1. / time_step * box.shortest(x - position[k]);
    position[k] = x;
    moved2 = std::max(moved2, norm_square(box.shortest(position[k] - searched[k])));
  }
  // Two spheres may have come closer by twice that.
  if (2. * std::sqrt(moved2) > 0.3 * largest)
    find_neighbours();
}

std::vector<Vec3> Packing::pack(const std::vector<double> &radii, const unsigned int seed,
                                const ParticleId first_id)
{
  radius = radii;
  largest = *std::max_element(radii.begin(), radii.end());
  position.resize(radii.size());
  velocity.assign(radii.size(), Vec3());
  force.assign(radii.size(), Vec3());
  std::tie(begin, end) = share_of(radii.size(), comm);
  scatter(seed, first_id);
  find_neighbours();

  // The constants of the paper; masses and stiffnesses are 1.
  constexpr double start = 0.1, longest = 0.6, mixing_at_start = 0.1;
  double time_step = start, mixing = mixing_at_start;
  unsigned int downhill = 0;
  for (unsigned int step = 0; step < most_steps; ++step) {
    if (compute_forces() <= margin)
      return position;
    double power = 0., force2 = 0., velocity2 = 0.;
    for (std::size_t k = 0; k < position.size(); ++k) {
      power += dot(force[k], velocity[k]);
      force2 += norm_square(force[k]);
      velocity2 += norm_square(velocity[k]);
    }
    if (power > 0.) {
      const double along = mixing * std::sqrt(velocity2 / force2);
      for (std::size_t k = 0; k < position.size(); ++k)
        velocity[k] = (1. - mixing) * velocity[k] + along * force[k];
      if (++downhill > 5) {
        time_step = std::min(1.1 * time_step, longest);
        mixing *= 0.99;
      }
    } else {
      std::fill(velocity.begin(), velocity.end(), Vec3());
      time_step *= 0.5;
      mixing = mixing_at_start;
      downhill = 0;
    }
    for (std::size_t k = 0; k < position.size(); ++k)
      velocity[k] += time_step * force[k];
    move(time_step);
  }
  throw UserError(
      "subsection 'insertion info' / entry 'insertion box points coordinates': the " +
      std::to_string(radii.size()) +
      " particles could not be packed into the box without overlap. Enlarge the box, "
      "or insert fewer particles; random packings fill up to about 0.6 of a wide box, less of a "
      "narrow one.");
}

/// Lethe's "packed": all particles at once, packed at random in a box without overlap.
class Packed : public Insertion
{
public:
  Packed(const InsertionSettings &settings, const PhysicalProperties &physics, MPI_Comm comm)
      : settings(settings), particles(physics.types), comm(comm)
  {
  }

  double largest_diameter() const override { return particles.largest_diameter(); }
  std::size_t supply(std::size_t) const override { return particles.n_remaining(); }
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
    double volume = 0.;
    for (const double r : radii(1))
      volume += sphere_mass(r, 1.);
    const double fraction = volume / ((high.x - low.x) * (high.y - low.y) * (high.z - low.z));
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
    Packing packing(
        settings.box_lower, settings.box_upper, periods,
        [&](const Vec3 &x) { return takes_all ? 1. : acceptance.value(0, x, 0.); },
        [this](const Vec3 &x) { return domain->contains(x); }, solids, comm);
    const std::vector<Vec3> places = packing.pack(radii(first), settings.seed, first);
    const auto [begin, end] = share_of(n, comm);
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle particle = particles.particle(k, first + static_cast<ParticleId>(k));
      particle.position = places[k];
      particle.velocity = settings.velocity;
      particle.spin = settings.spin;
      share.push_back(particle);
    }
    particles.take(n);
    return share;
  }

private:
  /// Of all particles that remain (m).
  std::vector<double> radii(ParticleId first_id) const
  {
    std::vector<double> all;
    for (std::size_t k = 0; k < particles.n_remaining(); ++k)
      all.push_back(particles.particle(k, first_id + static_cast<ParticleId>(k)).radius);
    return all;
  }

  const InsertionSettings settings;
  ParticleSupply particles;
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
