#include <eunoe/core/files.h>
#include <eunoe/particles/insertion.h>

namespace eunoe {
namespace {

/// Particles from files in Lethe's format, all of type 0, one file an event.
class File : public Insertion
{
public:
  File(const InsertionParameters &parameters, const PhysicalProperties &physics)
      : files(parameters.files), repeats(parameters.frequency > 0), type(physics.types[0])
  {
  }

  bool finished() const override { return !repeats && n_events > 0; }

  std::vector<NewParticle> next(ParticleId &next_id, MPI_Comm comm) override
  {
    const std::string &file = files[n_events++ % files.size()];
    const Table table = parse_table(read_file(file, comm), file);
    const auto column = [&](const char *name, bool required) {
      const int c = table.column(name);
      if (c < 0 && required)
        throw UserError(file + ":1: the header has no column '" + name +
                        "'. It is 'p_x; p_y; p_z; v_x; v_y; v_z; w_x; w_y; w_z; diameters'.");
      return c;
    };
    const int d = column("diameters", true);
    const int x[3] = {column("p_x", true), column("p_y", true), column("p_z", true)};
    const int v[3] = {column("v_x", false), column("v_y", false), column("v_z", false)};
    const int w[3] = {column("w_x", false), column("w_y", false), column("w_z", false)};
    const auto vector = [](const std::vector<double> &row, const int(&c)[3]) {
      const auto value = [&](int k) { return k < 0 ? 0. : row[k]; };
      return Vec3{value(c[0]), value(c[1]), value(c[2])};
    };

    const auto [begin, end] = share_of(table.rows.size(), comm);
    std::vector<NewParticle> particles;
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
      const auto &row = table.rows[k];
      if (!(row[d] > 0.) || !std::isfinite(row[d]))
        throw UserError(file + ": particle " + std::to_string(k) + " has a diameter of " +
                        format(row[d]) + " m. Give a positive diameter.");
      if (k < begin || k >= end)
        continue;
      NewParticle particle;
      particle.id = next_id + static_cast<ParticleId>(k);
      particle.radius = 0.5 * row[d];
      particle.mass = sphere_mass(particle.radius, type.density);
      particle.position = vector(row, x);
      particle.velocity = vector(row, v);
      particle.spin = vector(row, w);
      particles.push_back(particle);
    }
    next_id += static_cast<ParticleId>(table.rows.size());
    return particles;
  }

private:
  const std::vector<std::string> files;
  const bool repeats;
  const ParticleType type;
  std::size_t n_events = 0;
};

const InsertionRegistry::Registration registration(insertion_methods(), "file",
                                                   [](const InsertionParameters &parameters,
                                                      const PhysicalProperties &physics) {
                                                     return std::make_unique<File>(parameters,
                                                                                   physics);
                                                   });

} // namespace
} // namespace eunoe
