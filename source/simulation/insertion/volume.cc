#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/core/log.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/random.h>
#include <eunoe/domain/domain.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>
#include <utility>

namespace eunoe {

namespace {
/// More than any run can have ids for, and whole as a double.
constexpr double many = 0x1p32;
/// Points at which an acceptance function is asked, as many as fit into some seconds.
constexpr std::size_t most_restricted = 100000000;
} // namespace

double VolumeGrid::points_along(const unsigned int d) const
{
  return std::clamp(std::floor((upper[d] - lower[d]) / pitch + 1e-9), 0., many);
}

std::size_t VolumeGrid::capacity() const
{
  if (restricted)
    return accepted.size();
  return static_cast<std::size_t>(
      std::min(points_along(0) * points_along(1) * points_along(2), many));
}

Vec3 VolumeGrid::cell(std::size_t k) const
{
  Vec3 x;
  for (const int d : order) {
    const auto n = static_cast<std::size_t>(points_along(static_cast<unsigned int>(d)));
    x[d] = lower[d] + (k % n) * pitch;
    k /= n;
  }
  return x;
}

Vec3 VolumeGrid::point(const std::size_t k, const unsigned int seed, const ParticleId id) const
{
  Vec3 x = cell(restricted ? accepted[k] : k);
  for (const int d : order) {
    const double slack = pitch - offset;
    x[d] = x[d] + 0.5 * slack +
           offset * uniform(seed, Draw::offset, id, static_cast<std::uint32_t>(d));
  }
  return x;
}

void VolumeGrid::restrict_to(const std::function<bool(const Vec3 &)> &accepts)
{
  std::vector<std::uint32_t> list;
  const std::size_t n = capacity();
  const Vec3 middle = {0.5 * pitch, 0.5 * pitch, 0.5 * pitch};
  for (std::size_t k = 0; k < n; ++k)
    if (accepts(cell(k) + middle))
      list.push_back(static_cast<std::uint32_t>(k));
  accepted = std::move(list); // it may be hundreds of megabytes
  restricted = true;
}

namespace {

/// How the points of the grid are filled.
struct Filling
{
  unsigned int per_event = 0; ///< "inserted number of particles at each time step"
  std::vector<int> directions = {0, 1, 2};
  double distance_threshold = 1.; ///< distance of the points over the largest diameter
};

/// Lethe's "volume": events that fill a grid of points in a box, one type after another.
class Volume : public Insertion
{
public:
  Volume(const InsertionSettings &settings, const Filling &filling,
         const PhysicalProperties &physics, MPI_Comm comm)
      : settings(settings), per_event(filling.per_event), particles(physics.types), comm(comm)
  {
    grid.lower = settings.box_lower;
    grid.upper = settings.box_upper;
    grid.pitch = filling.distance_threshold * largest_diameter();
    grid.offset = settings.maximum_offset * largest_diameter();
    grid.order = filling.directions;
    const std::size_t n_points = grid.capacity();
    if (settings.acceptance != "1")
      restrict_grid();
    refuse_what_has_no_room(n_points);
    if (settings.frequency == 0 && of_next_event() < particles.n_remaining())
      throw UserError(
          "subsection 'insertion info' / entry 'inserted number of particles at each time step' "
          "is " +
          std::to_string(per_event) + ", but all " + std::to_string(particles.n_remaining()) +
          " particles come in a single event, as the 'insertion frequency' is 0. Set it to 0 for "
          "all at once, or set an 'insertion frequency'.");
  }

  double largest_diameter() const override { return particles.largest_diameter(); }

  std::size_t supply(const std::size_t n_events) const override
  {
    // Also of those that came before a restart.
    const std::size_t of_event = std::min(of_one_event(n_all), grid.capacity());
    const bool all = of_event > 0 && n_events >= n_all / of_event + 1;
    return all ? n_all : std::min(n_all, n_events * of_event);
  }

  void skip(std::size_t, std::size_t n_particles) override { particles.take(n_particles); }

  bool finished() const override { return particles.n_remaining() == 0; }

  bool repeats_places() const override { return true; }

  void check(const Domain &domain, Problems &problems) const override
  {
    for (unsigned int d = 0; d < 3 && particles.n_remaining() > 0; ++d)
      if (grid.lower[d] > domain.upper()[d] || grid.upper[d] < domain.lower()[d]) {
        problems.add("subsection 'insertion info' / entry 'insertion box points coordinates':",
                     "the box lies outside the mesh in direction " + std::to_string(d) +
                         ", which spans " + format(domain.lower()[d]) + " to " +
                         format(domain.upper()[d]) + " m.",
                     "Move the box inside, or enlarge the mesh.");
        break;
      }
  }

  std::vector<std::vector<NewParticle>> known_events() const override
  {
    constexpr std::size_t most = 50000;
    const std::size_t n = std::min(of_next_event(), grid.capacity());
    return {some(1, std::max<std::size_t>(1, n / most))};
  }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    const std::size_t n = std::min(of_next_event(), grid.capacity());
    std::vector<NewParticle> share = some(ids.take(n), 1);
    particles.take(n);
    return share;
  }

private:
  /// Every so many of this rank's share of the next event.
  std::vector<NewParticle> some(const ParticleId first_id, const std::size_t stride) const
  {
    const std::size_t n = std::min(of_next_event(), grid.capacity());
    const auto [begin, end] = share_of(n, comm);
    std::vector<NewParticle> share;
    for (std::size_t k = begin; k < end; k += stride) {
      NewParticle p = particles.particle(k, first_id + static_cast<ParticleId>(k));
      p.position = grid.point(k, settings.seed, p.id);
      p.velocity = settings.velocity;
      p.spin = settings.spin;
      share.push_back(p);
    }
    return share;
  }

  /// @param n_points of the grid before the acceptance function left some out
  void refuse_what_has_no_room(const std::size_t n_points) const
  {
    const std::size_t room = grid.capacity(), wanted = particles.n_remaining();
    if (wanted > 0 && room == 0 && n_points > 0)
      throw UserError("subsection 'insertion info' / subsection 'insertion acceptance function' / "
                      "entry 'Function expression' is '" +
                      shortened(settings.acceptance) + "', which is positive at none of the " +
                      format_count(static_cast<double>(n_points), "point", "points") +
                      " of the insertion box. Lengths are in metres: correct the expression or "
                      "the box.");
    const std::string box =
        "subsection 'insertion info' / entry 'insertion box points coordinates' gives a box with "
        "room for " +
        format_count(static_cast<double>(room), "particle", "particles") +
        (room < n_points ? " where the acceptance function is positive, but " : ", but ");
    const Vec3 extent = grid.upper - grid.lower;
    const double narrowest = std::min({extent.x, extent.y, extent.z});
    if (wanted > 0 && room == 0 && largest_diameter() > narrowest)
      throw UserError(
          box + "grains are up to " + format(largest_diameter()) + " m wide, and it is " +
          format(narrowest) +
          " m at its narrowest. Lengths are in metres: correct the diameter or the box.");
    if (wanted > 0 && room == 0)
      throw UserError(box + "there are particles to insert. Enlarge the box.");
    if (settings.frequency == 0 && room < of_next_event())
      throw UserError(box + std::to_string(of_next_event()) +
                      " are to be inserted at once. Enlarge the box, or set an 'insertion "
                      "frequency' for several events.");
  }

  void restrict_grid()
  {
    // A wrong text has been refused when the parameters were checked.
    const Expressions acceptance(settings.acceptance, settings.acceptance_constants, 1);
    if (grid.capacity() > most_restricted)
      throw UserError("subsection 'insertion info': the acceptance function would be asked at " +
                      std::to_string(grid.capacity()) +
                      " points. Make the insertion box smaller, or the distance threshold larger.");
    grid.restrict_to([&](const Vec3 &x) { return acceptance.value(0, x, 0.) > 0.; });
  }
  std::size_t of_one_event(const std::size_t left) const
  {
    return per_event > 0 ? std::min<std::size_t>(per_event, left) : left;
  }
  std::size_t of_next_event() const { return of_one_event(particles.n_remaining()); }

  const InsertionSettings settings;
  const unsigned int per_event;
  ParticleSupply particles;
  const std::size_t n_all = particles.n_remaining(); ///< before the first event
  MPI_Comm comm;
  VolumeGrid grid;
};

class VolumeSection : public InsertionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::count(prm, "inserted number of particles at each time step", filling.per_event,
                   "volume: number of particles of an event.");
    declare::list(prm, "insertion direction sequence", filling.directions, {3, 3, 0, 2},
                  "volume: axes in the order in which the box is filled.");
    declare::at_least(prm, "insertion distance threshold", filling.distance_threshold, 0.5,
                      "volume: distance of the grid points over the largest diameter.");
  }

  void check(const InsertionSettings &settings, const ParameterCheck &check) const override
  {
    const ParameterCheck::Path section = {InsertionParameters::section};
    settings.check_box(check);
    std::vector<int> sorted = filling.directions;
    std::sort(sorted.begin(), sorted.end());
    check.require(sorted == std::vector<int>({0, 1, 2}), section, "insertion direction sequence",
                  "does not name each axis once.", "Give a permutation of 0, 1, 2.");
    check.advise(settings.maximum_offset <= filling.distance_threshold - 1. + 1e-12, section,
                 "insertion maximum offset",
                 "of " + format(settings.maximum_offset) +
                     " lets neighbours overlap at a threshold of " +
                     format(filling.distance_threshold) + ".",
                 "Give at most 'insertion distance threshold' - 1, or raise the threshold.");
  }

  void announce(const InsertionSettings &settings, const PhysicalProperties &physics,
                Log &log) const override
  {
    // They take a second, more or less.
    constexpr double many_points = 2e6;
    if (settings.acceptance == "1")
      return;
    const double pitch = filling.distance_threshold * physics.largest_diameter();
    const Vec3 size = settings.box_upper - settings.box_lower;
    const double points = size.x * size.y * size.z / (pitch * pitch * pitch);
    if (points > many_points)
      log.line("Asking the insertion acceptance function at about " + format(points) +
               " points ...");
  }

  std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                  const PhysicalProperties &physics, MPI_Comm comm) const override
  {
    return std::make_unique<Volume>(settings, filling, physics, comm);
  }

private:
  Filling filling;
};

const InsertionRegistry::Registration registration(insertion_methods(), "volume", [] {
  return std::make_unique<VolumeSection>();
});

} // namespace
} // namespace eunoe
