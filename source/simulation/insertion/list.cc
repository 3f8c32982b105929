#include <eunoe/core/declare.h>
#include <eunoe/core/log.h>
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

/// Particles written into the input one by one, again at every event, until there are as many of
/// a type as it has; then those of the next type. Where type 0 has no number it comes once.
class List : public Insertion
{
public:
  List(const Lists &lists, const bool repeats, const PhysicalProperties &physics, MPI_Comm comm)
      : p(lists), comm(comm)
  {
    const std::size_t n = p.x.size();
    for (std::size_t k = 0; k < physics.types.size(); ++k) {
      Kind kind = {static_cast<int>(k), physics.types[k], physics.types[k].sizes.make(), 0};
      kind.number = k == 0 && kind.type.number == 0 ? n : kind.type.number;
      n_events += events_of(kind);
      kinds.push_back(std::move(kind));
    }
    n_all_events = n_events;
    if (!repeats)
      n_events = 1;
  }

  double largest_diameter() const override
  {
    double largest = p.diameters.empty() ? largest_of_types() : 0.;
    for (const double diameter : p.diameters)
      largest = std::max(largest, diameter > 0. ? diameter : largest_of_types());
    return largest;
  }

  bool gives_particles() const override { return true; }

  bool repeats_places() const override { return true; }

  std::size_t supply(const std::size_t n) const override
  {
    std::size_t sum = 0, left = std::min(n, n_events);
    for (const Kind &kind : kinds) {
      const std::size_t of_kind = std::min(left, events_of(kind));
      sum += std::min(of_kind * p.x.size(), kind.number);
      left -= of_kind;
    }
    return sum;
  }

  std::vector<Vec3> known_places() const override
  {
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < p.x.size(); ++k)
      places.push_back({p.x[k], p.y[k], p.z[k]});
    return places;
  }

  std::vector<std::vector<NewParticle>> known_events() const override
  {
    // The first of each type.
    std::vector<std::vector<NewParticle>> events = {particles(event_of(0), 1)};
    std::size_t event = 0;
    for (const Kind &kind : kinds) {
      if (event > 0 && event < n_events && events_of(kind) > 0)
        events.push_back(particles(event_of(event), 1));
      event += events_of(kind);
    }
    return events;
  }

  void skip(const std::size_t n, std::size_t) override { n_done = n; }

  std::size_t events_for(std::size_t n_particles) const override
  {
    // All methods supply type by type.
    std::size_t events = 0;
    for (const Kind &kind : kinds) {
      const std::size_t of_kind = std::min(n_particles, kind.number);
      events += (of_kind + p.x.size() - 1) / p.x.size();
      n_particles -= of_kind;
    }
    return events;
  }

  bool finished() const override { return n_done >= n_events; }

  bool has_more() const override { return n_done < n_all_events; }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    const Event event = event_of(n_done++);
    return particles(event, ids.take(event.number));
  }

private:
  struct Kind
  {
    int number_of_type;
    ParticleType type;
    std::unique_ptr<SizeDistribution> sizes;
    std::size_t number; ///< of particles
  };

  /// The first so many of the list, as particles of a kind.
  struct Event
  {
    const Kind *kind;
    std::size_t number;
  };

  std::size_t events_of(const Kind &kind) const
  {
    return (kind.number + p.x.size() - 1) / p.x.size();
  }

  Event event_of(std::size_t event) const
  {
    const std::size_t n = p.x.size();
    for (const Kind &kind : kinds) {
      if (event < events_of(kind))
        return {&kind, std::min(n, kind.number - event * n)};
      event -= events_of(kind);
    }
    return {&kinds.back(), 0};
  }

  double largest_of_types() const
  {
    double largest = 0.;
    for (const Kind &kind : kinds)
      largest = std::max(largest, kind.sizes->largest());
    return largest;
  }

  /// This rank's share of an event.
  std::vector<NewParticle> particles(const Event &event, const ParticleId first) const
  {
    const auto value = [](const std::vector<double> &list, std::size_t k) {
      return k < list.size() ? list[k] : 0.;
    };
    const ParticleType &type = event.kind->type;
    const auto [begin, end] = share_of(event.number, comm);
    std::vector<NewParticle> share;
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle particle;
      particle.id = first + static_cast<ParticleId>(k);
      particle.type = event.kind->number_of_type;
      const double wanted = value(p.diameters, p.diameters.size() == 1 ? 0 : k);
      const double diameter =
          wanted > 0.
              ? wanted
              : event.kind->sizes->diameter(uniform(type.sizes.seed, Draw::size, particle.id));
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
  MPI_Comm comm;
  std::vector<Kind> kinds;
  std::size_t n_events = 0, n_all_events = 0, n_done = 0;
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
                        std::string(values == &lists.diameters
                                        ? ", or one for all; empty: sizes of the type."
                                    : name.size() > 6 ? "; 0 for those without one."
                                                      : "."));
  }

  void check(const InsertionSettings &, const ParameterCheck &check) const override
  {
    const ParameterCheck::Path section = {InsertionParameters::section};
    const std::size_t n = lists.x.size();
    const auto fits = [&](const std::vector<double> &list, const bool ok) {
      check.require(ok, section, "list x",
                    "has " + std::to_string(n) + " values, another list " +
                        std::to_string(list.size()) + ".",
                    "Give one value a particle in every list.");
    };
    check.require(!lists.x.empty(), section, "list x", "is empty.",
                  "Give the coordinates of at least one particle.");
    for (const std::vector<double> *const list : {&lists.y, &lists.z})
      fits(*list, list->size() == n);
    fits(lists.diameters, lists.diameters.size() == n || lists.diameters.size() <= 1);
    // A single -1 is Lethe's default: sizes of the type.
    const auto wrong = std::find_if(lists.diameters.begin(), lists.diameters.end(),
                                    [](const double diameter) { return !(diameter > 0.); });
    if (wrong != lists.diameters.end() && lists.diameters != std::vector<double>{-1.})
      check.require(false, section, "list diameters", "holds " + format(*wrong) + " m.",
                    "Give positive diameters, or leave the list empty for sizes of the type.");
    for (const std::vector<double> *const list :
         {&lists.vx, &lists.vy, &lists.vz, &lists.wx, &lists.wy, &lists.wz})
    {
      fits(*list, list->size() <= n);
      check.advise(list->empty() || list->size() >= n, section, "list x",
                   "has " + std::to_string(n) + " values, and a list of velocities " +
                       std::to_string(list->size()) + ": the other particles have 0 there.",
                   "Give one value a particle in every list.");
    }
  }

  void announce(const InsertionSettings &, const PhysicalProperties &physics,
                Log &log) const override
  {
    const unsigned int number = physics.types[0].number;
    if (number > 0 && number < lists.x.size())
      log.line("The list has " + std::to_string(lists.x.size()) +
               " particles, of which the first " + std::to_string(number) +
               " come at a time: that is the 'number of particles' of type 0.");
  }

  std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                  const PhysicalProperties &physics, MPI_Comm comm) const override
  {
    return std::make_unique<List>(lists, settings.frequency > 0, physics, comm);
  }

private:
  Lists lists;
};

const InsertionRegistry::Registration registration(insertion_methods(), "list",
                                                   [] { return std::make_unique<ListSection>(); });

} // namespace
} // namespace eunoe
