#include <eunoe/core/declare.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/log.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/table.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace eunoe {
namespace {

const char *const names[] = {"p_x", "p_y", "p_z", "v_x", "v_y",
                             "v_z", "w_x", "w_y", "w_z", "diameters"};

/// Columns that a file may leave out; they are zero then.
bool may_lack(const std::string &column)
{
  return column[0] == 'v' || column[0] == 'w';
}

/// Particles from files in Lethe's format, all of type 0, one file an event, until there are as
/// many as the type has; any number if that is 0.
class File : public Insertion
{
public:
  File(const std::vector<std::string> &paths, const bool repeats, const PhysicalProperties &physics,
       MPI_Comm comm)
      : repeats(repeats), density(physics.types[0].density),
        most(physics.types[0].number > 0 ? physics.types[0].number
                                         : std::numeric_limits<std::size_t>::max())
  {
    for (const std::string &file : paths)
      read(file, comm);
  }

  double largest_diameter() const override { return largest; }

  bool gives_particles() const override { return true; }

  std::size_t supply(const std::size_t n_events) const override
  {
    const std::size_t events = repeats ? n_events : 1, rest = events % files.size();
    std::size_t round = 0, last_round = 0;
    for (std::size_t k = 0; k < files.size(); ++k) {
      round += files[k].n;
      last_round += k < rest ? files[k].n : 0;
    }
    return std::min(most, events / files.size() * round + last_round);
  }

  bool is_cut_short() const override
  {
    std::size_t given = 0;
    for (std::size_t k = 0; k < n_in_first_round(); ++k)
      given += files[k].n;
    return most < given;
  }

  std::vector<Vec3> known_places() const override
  {
    std::vector<Vec3> places;
    std::size_t left = most;
    for (std::size_t k = 0; k < n_in_first_round(); ++k) {
      for (const NewParticle &particle : files[k].share)
        if (particle.id < left)
          places.push_back(particle.position);
      left -= std::min(left, files[k].n);
    }
    return places;
  }

  std::vector<std::vector<NewParticle>> known_events() const override
  {
    std::vector<std::vector<NewParticle>> events;
    std::size_t left = most;
    for (std::size_t k = 0; k < n_in_first_round() && left > 0; ++k) {
      events.push_back(first_of(files[k].share, left));
      left -= std::min(left, files[k].n);
    }
    return events;
  }

  void skip(std::size_t n, std::size_t n_particles) override
  {
    n_events = n;
    n_supplied = n_particles;
  }

  bool finished() const override { return n_supplied >= most || (!repeats && n_events > 0); }

  bool has_more() const override
  {
    return most < std::numeric_limits<std::size_t>::max() ? n_supplied < most : !finished();
  }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    Contents &file = files[n_events++ % files.size()];
    const std::size_t n = std::min(file.n, most - n_supplied);
    n_supplied += n;
    const ParticleId first = ids.take(n);
    // A file that is not needed again is not kept.
    std::vector<NewParticle> particles = first_of(repeats ? file.share : std::move(file.share), n);
    for (NewParticle &particle : particles)
      particle.id += first;
    return particles;
  }

private:
  /// A file: number of its particles, and this rank's share of them with ids from 0.
  struct Contents
  {
    std::size_t n;
    std::vector<NewParticle> share;
  };

  /// Files that come before the first comes again.
  std::size_t n_in_first_round() const { return repeats ? files.size() : 1; }

  /// Those of this rank's share that are among the first @p n of their file.
  static std::vector<NewParticle> first_of(std::vector<NewParticle> share, const std::size_t n)
  {
    share.erase(std::remove_if(share.begin(), share.end(),
                               [n](const NewParticle &particle) { return particle.id >= n; }),
                share.end());
    return share;
  }

  void read(const std::string &file, MPI_Comm comm)
  {
    Contents contents = {0, {}};
    std::vector<int> place; // of each column in a row
    const Table columns =
        read_table_in_parts(file, comm, [&](const Table &table, const std::vector<double> &row) {
          if (place.empty())
            place = places_in(table);
          contents.share.push_back(particle(row, place));
        });
    for (unsigned int c = 0; c < std::size(names); ++c)
      if (places_in(columns)[c] < 0 && !may_lack(names[c]))
        throw UserError(file + ":1: the header has no column '" + names[c] +
                        "'. It is 'p_x; p_y; p_z; v_x; v_y; v_z; w_x; w_y; w_z; diameters'.");
    const std::uint64_t n = contents.share.size();
    std::uint64_t first = 0, n_all;
    MPI_Exscan(&n, &first, 1, MPI_UINT64_T, MPI_SUM, comm);
    if (is_first_rank(comm))
      first = 0; // which MPI leaves undefined
    MPI_Allreduce(&n, &n_all, 1, MPI_UINT64_T, MPI_SUM, comm);
    contents.n = n_all;
    on_every_rank(comm, [&] {
      for (std::size_t k = 0; k < n; ++k) {
        contents.share[k].id = static_cast<ParticleId>(first + k);
        refuse_nonsense(contents.share[k], file, first + k);
      }
    });
    contents.share.shrink_to_fit();
    for (const NewParticle &particle : contents.share)
      largest = std::max(largest, 2. * particle.radius);
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, comm);
    files.push_back(std::move(contents));
  }

  /// Places of the columns in a row; -1 for those that are missing.
  static std::vector<int> places_in(const Table &table)
  {
    std::vector<int> places;
    for (const char *const name : names)
      places.push_back(table.column(name));
    return places;
  }

  NewParticle particle(const std::vector<double> &row, const std::vector<int> &place) const
  {
    const auto value = [&](const unsigned int c) { return place[c] < 0 ? 0. : row[place[c]]; };
    NewParticle particle;
    particle.radius = 0.5 * value(9);
    particle.mass = sphere_mass(particle.radius, density);
    particle.position = {value(0), value(1), value(2)};
    particle.velocity = {value(3), value(4), value(5)};
    particle.spin = {value(6), value(7), value(8)};
    return particle;
  }

  /// @param number of the particle in its file, from 0
  static void refuse_nonsense(const NewParticle &particle, const std::string &file,
                              const std::uint64_t number)
  {
    const Vec3 &x = particle.position, &v = particle.velocity, &w = particle.spin;
    const double values[] = {x.x, x.y, x.z, v.x, v.y, v.z, w.x, w.y, w.z, 2. * particle.radius};
    for (unsigned int c = 0; c < std::size(values); ++c)
      if (!std::isfinite(values[c]))
        throw UserError(file + ": particle " + std::to_string(number) + " has " +
                        format(values[c]) + " as its '" + names[c] + "'. Give a number.");
    if (!(particle.radius > 0.))
      throw UserError(file + ": particle " + std::to_string(number) + " has a diameter of " +
                      format(2. * particle.radius) + " m. Give a positive diameter.");
  }

  const bool repeats;
  const double density;
  const std::size_t most; ///< particles in all
  std::vector<Contents> files;
  double largest = 0.;
  std::size_t n_events = 0, n_supplied = 0;
};

class FileSection : public InsertionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::files(prm, "list of input files", files,
                   "file: the files, one an event, with the header 'p_x; p_y; p_z; v_x; v_y; v_z; "
                   "w_x; w_y; w_z; diameters'; after the last the first is used again, until there "
                   "are as many "
                   "particles as their type has, or without an end if that number is 0.");
  }

  void check(const InsertionSettings &settings, const ParameterCheck &check) const override
  {
    const ParameterCheck::Path path = {InsertionParameters::section};
    check.require(!files.empty(), path, "list of input files", "is empty.",
                  "Name at least one file.");
    check.advise(settings.frequency > 0 || files.size() < 2, path, "list of input files",
                 "names " + std::to_string(files.size()) +
                     " files, one an event, and with an 'insertion frequency' of 0 there is one "
                     "event, so that only the first is used.",
                 "Give an 'insertion frequency', or one file.");
  }

  void announce(const InsertionSettings &, const PhysicalProperties &, Log &log) const override
  {
    // They take a second, more or less.
    constexpr double many_bytes = 5e7;
    for (const std::string &file : files)
      if (file_size(file) > many_bytes)
        log.line("Reading " + format_bytes(file_size(file)) + " of particles from " +
                 shortened(file) + " ...");
  }

  std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                  const PhysicalProperties &physics, MPI_Comm comm) const override
  {
    return std::make_unique<File>(files, settings.frequency > 0, physics, comm);
  }

private:
  std::vector<std::string> files = {"particles.input"};
};

const InsertionRegistry::Registration registration(insertion_methods(), "file",
                                                   [] { return std::make_unique<FileSection>(); });

} // namespace
} // namespace eunoe
