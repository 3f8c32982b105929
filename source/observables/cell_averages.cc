#include <eunoe/domain/cell_locator.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/simulation/patch_list.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <array>
#include <map>

namespace eunoe {
namespace {

using Cell = dealii::Triangulation<3>::active_cell_iterator;
/// What counts of a particle.
struct Row
{
  ParticleId id = 0;
  Vec3 place;         ///< in the frame of the mesh (m)
  Vec3 velocity;      ///< (m/s)
  double volume = 0.; ///< (m3)
  bool is_awake = true;

  /// For its way to another rank.
  template <typename Archive>
  void serialize(Archive &archive, unsigned int /*version*/)
  {
    archive &id &place.x &place.y &place.z &velocity.x &velocity.y &velocity.z &volume &is_awake;
  }
};

/// The averages of one cell.
struct Averages
{
  double number = 0.;
  Vec3 velocity;           ///< mean over the particles (m/s)
  double temperature = 0.; ///< a third of the mean square of the deviation from it (m2/s2)
  double awake = 0.;       ///< share of the particles that do not sleep
  double fraction = 0.;    ///< volume of the particles whose centres are in it, over its own

  Averages(std::vector<Row> rows, double volume)
  {
    if (rows.empty())
      return;
    // By id, so that sums are the same on any number of ranks.
    std::sort(rows.begin(), rows.end(), [](const Row &a, const Row &b) { return a.id < b.id; });
    number = static_cast<double>(rows.size());
    for (const Row &row : rows) {
      velocity += row.velocity;
      fraction += row.volume;
      awake += (row.is_awake ? 1. : 0.) / number;
    }
    velocity = velocity / number;
    for (const Row &row : rows)
      temperature += norm_square(row.velocity - velocity);
    temperature /= 3. * number;
    fraction /= volume;
  }
};

/// Cells with data that are constant in each, in the form in which deal.II writes them.
class CellPatches : public PatchList<3>
{
public:
  CellPatches()
  {
    add_name("velocity", 3);
    for (const char *const name : {"granular_temperature", "solid_fraction", "particles", "awake"})
      add_name(name);
  }

  void add(const Cell &cell, const Averages &a, const Domain &domain)
  {
    Patch patch;
    patch.patch_index = static_cast<unsigned int>(patches.size());
    patch.n_subdivisions = 1;
    patch.reference_cell = dealii::ReferenceCells::Hexahedron;
    const std::array<double, 7> values = {a.velocity.x, a.velocity.y, a.velocity.z, a.temperature,
                                          a.fraction,   a.number,     a.awake};
    patch.data.reinit(n_data(), cell->n_vertices());
    for (const unsigned int v : cell->vertex_indices()) {
      patch.vertices[v] = to_point(domain.to_space(to_vec3(cell->vertex(v))));
      for (unsigned int c = 0; c < values.size(); ++c)
        patch.data(c, v) = static_cast<float>(values[c]);
    }
    patches.push_back(patch);
  }
};

/// Particles by the mesh cells that they are in, wherever these are.
class Sorting
{
public:
  explicit Sorting(const Domain &domain)
      : domain(domain), comm(domain.communicator()), locator(domain)
  {
    const Box &own = locator.box();
    const std::array<double, 6> numbers = {
        {own.lower.x, own.lower.y, own.lower.z, own.upper.x, own.upper.y, own.upper.z}};
    for (const auto &n : dealii::Utilities::MPI::all_gather(comm, numbers))
      boxes.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }

  /// The particles in each of this rank's mesh cells, by active index; collective.
  std::vector<std::vector<Row>> operator()(const ParticleArrays &p) const
  {
    std::map<unsigned int, std::vector<Row>> asked;
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const Row row = {p.id[k], domain.to_own_frame(domain.periods().wrap(p.position[k].vec())),
                       p.velocity[k].vec(), sphere_mass(p.radius(k), 1.), p.is_awake(k)};
      for (const unsigned int rank : ranks_of(row.place))
        asked[rank].push_back(row);
    }
    std::map<ParticleId, Candidate> candidates;
    for (const auto &[rank, parcel] : dealii::Utilities::MPI::some_to_some(comm, asked))
      for (const Row &row : parcel) {
        Candidate candidate;
        candidate.row = row;
        candidate.fit = locator.find(row.place, candidate.cell);
        candidates.emplace(row.id, candidate);
      }
    leave_out_worse(candidates);
    std::vector<std::vector<Row>> rows(domain.mesh().triangulation.n_active_cells());
    for (const auto &[id, candidate] : candidates)
      rows[candidate.cell->active_cell_index()].push_back(candidate.row);
    return rows;
  }

private:
  /// A particle in the best of this rank's cells.
  struct Candidate
  {
    Row row;
    Cell cell;
    CellLocator::Fit fit;
  };

  /// The ranks whose boxes a place is in, or nearest to; the same on every rank.
  std::vector<unsigned int> ranks_of(const Vec3 &x) const
  {
    std::vector<double> squares;
    for (const Box &box : boxes) {
      double square = 0.;
      for (unsigned int d = 0; d < 3; ++d) {
        const double out = std::max({0., box.lower[d] - x[d], x[d] - box.upper[d]});
        square += out * out;
      }
      squares.push_back(square);
    }
    const double least = *std::min_element(squares.begin(), squares.end());
    std::vector<unsigned int> ranks;
    for (unsigned int rank = 0; rank < squares.size(); ++rank)
      if (squares[rank] <= least)
        ranks.push_back(rank);
    return ranks;
  }

  /// Leaves out particles for which another rank has a better cell; collective.
  void leave_out_worse(std::map<ParticleId, Candidate> &candidates) const
  {
    const unsigned int own = dealii::Utilities::MPI::this_mpi_process(comm);
    // Id, how far outside, centre of the cell.
    using Answer = std::array<double, 5>;
    std::map<unsigned int, std::vector<Answer>> answers;
    for (const auto &[id, candidate] : candidates)
      for (const unsigned int rank : ranks_of(candidate.row.place))
        if (rank != own) {
          const CellLocator::Fit &fit = candidate.fit;
          answers[rank].push_back(
              {{static_cast<double>(id), fit.outside, fit.centre.x, fit.centre.y, fit.centre.z}});
        }
    for (const auto &[rank, parcel] : dealii::Utilities::MPI::some_to_some(comm, answers))
      for (const Answer &a : parcel) {
        const auto found = candidates.find(static_cast<ParticleId>(a[0]));
        const CellLocator::Fit other = {a[1], {a[2], a[3], a[4]}};
        if (found != candidates.end() && other.is_better_than(found->second.fit))
          candidates.erase(found);
      }
  }

  const Domain &domain;
  MPI_Comm comm;
  const CellLocator locator;
  std::vector<Box> boxes; ///< around the cells of each rank
};

/// Mean velocity, granular temperature and solid fraction of the cells of the mesh, as pictures.
class CellAverages : public Observable
{
public:
  CellAverages(const SwitchSection &, Simulation &simulation)
      : pictures(simulation.output_folder().pictures(
            simulation.get_parameters().control.output_name + "_cells")),
        sort(simulation.get_domain())
  {
  }

  void draw(Simulation &simulation) override
  {
    const Domain &domain = simulation.get_domain();
    const std::vector<std::vector<Row>> rows = sort(simulation.complete_step());
    CellPatches patches;
    for (const auto &cell : domain.mesh().triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        patches.add(cell, Averages(rows[cell->active_cell_index()], cell->measure()), domain);
    pictures->write(simulation.time(), patches);
  }

private:
  const std::shared_ptr<PictureSeries> pictures;
  const Sorting sort;
};

/// What the input file says of them.
class CellAveragesSection : public SectionOf<CellAverages, SwitchSection>
{
public:
  using SectionOf<CellAverages, SwitchSection>::SectionOf;
  bool needs_cells() const override { return calculation; }
};

const ObservableRegistry::Registration registration(observables(), "cell averages", [] {
  return std::make_unique<CellAveragesSection>(
      "lagrangian post-processing",
      "Whether mean velocity, granular temperature and solid fraction of every "
      "cell of the mesh are drawn with every picture.");
});

} // namespace
} // namespace eunoe
