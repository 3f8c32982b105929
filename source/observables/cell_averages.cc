#include <eunoe/domain/mesh.h>
#include <eunoe/simulation/patch_list.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <array>
#include <map>

namespace eunoe {
namespace {

using Cell = dealii::Triangulation<3>::active_cell_iterator;
using CellOfAnyLevel = dealii::Triangulation<3>::cell_iterator;

/// The cell that holds a point near one of box-shaped cells; a point on a face belongs to the cell
/// on the upper side, and one beyond the boundary to the cell inside.
Cell cell_of(Cell cell, const Vec3 &x)
{
  // A particle goes less than a cell's width between two searches: a step in each direction at
  // most.
  for (unsigned int steps = 0; steps < 6; ++steps) {
    bool stays = true;
    for (const unsigned int f : cell->face_indices()) {
      const Vec3 out = to_vec3(cell->face(f)->center() - cell->center());
      unsigned int d = std::abs(out.x) > std::abs(out.y) ? 0 : 1;
      d = std::abs(out.z) > std::abs(out[d]) ? 2 : d;
      const double at = cell->face(f)->vertex(0)[d];
      const bool is_beyond = out[d] > 0. ? x[d] >= at : x[d] < at;
      if (!is_beyond || cell->at_boundary(f))
        continue;
      CellOfAnyLevel next = cell->neighbor(f);
      const auto distance = [&x](const CellOfAnyLevel &c) {
        return norm_square(to_vec3(c->center()) - x);
      };
      while (next->has_children()) {
        CellOfAnyLevel nearest = next->child(0);
        for (unsigned int c = 1; c < next->n_children(); ++c)
          if (distance(next->child(c)) <= distance(nearest))
            nearest = next->child(c);
        next = nearest;
      }
      if (next->is_artificial())
        continue;
      cell = next;
      stays = false;
      break;
    }
    if (stays)
      break;
  }
  return cell;
}

/// What counts of a particle.
struct Row
{
  ParticleId id = 0;
  Vec3 velocity;      ///< (m/s)
  double volume = 0.; ///< (m3)
  bool is_awake = true;

  /// For its way to another rank.
  template <typename Archive>
  void serialize(Archive &archive, unsigned int /*version*/)
  {
    archive &id &velocity.x &velocity.y &velocity.z &volume &is_awake;
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

/// Mean velocity, granular temperature and solid fraction of the cells of the mesh, as pictures.
class CellAverages : public Observable
{
public:
  CellAverages(const SwitchSection &, Simulation &simulation)
      : pictures(simulation.output_folder().pictures(
            simulation.get_parameters().control.output_name + "_cells"))
  {
  }

  void draw(Simulation &simulation) override
  {
    const Domain &domain = simulation.get_domain();
    const std::vector<std::vector<Row>> rows = rows_of_cells(simulation);
    CellPatches patches;
    for (const auto &cell : domain.mesh().triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        patches.add(cell, Averages(rows[cell->active_cell_index()], cell->measure()), domain);
    pictures->write(simulation.time(), patches);
  }

private:
  /// The particles in each of this rank's cells, by active index; collective.
  static std::vector<std::vector<Row>> rows_of_cells(Simulation &simulation)
  {
    const Domain::Mesh &mesh = simulation.get_domain().mesh();
    const ParticleStore &store = simulation.get_system().get_store();
    std::vector<Cell> cells;
    for (const auto &cell : mesh.triangulation.active_cell_iterators())
      cells.push_back(cell);
    std::vector<std::vector<Row>> rows(cells.size());
    // Particles have moved since they were sorted into cells, perhaps to those of other ranks.
    std::map<unsigned int, std::vector<std::pair<dealii::CellId, Row>>> foreign;
    const ParticleArrays &p = simulation.complete_step();
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const Cell found = cells[store.cell(k)];
      const Cell cell = mesh.has_boxes ? cell_of(found, p.position[k].vec()) : found;
      const Row row = {p.id[k], p.velocity[k].vec(), sphere_mass(p.radius(k), 1.), p.is_awake(k)};
      if (cell->is_locally_owned())
        rows[cell->active_cell_index()].push_back(row);
      else
        foreign[cell->subdomain_id()].emplace_back(cell->id(), row);
    }
    for (const auto &[rank, parcel] :
         dealii::Utilities::MPI::some_to_some(simulation.communicator(), foreign))
      for (const auto &[id, row] : parcel) {
        const Cell cell = mesh.triangulation.create_cell_iterator(id);
        rows[cell->active_cell_index()].push_back(row);
      }
    return rows;
  }

  const std::shared_ptr<PictureSeries> pictures;
};

const ObservableRegistry::Registration registration(observables(), "cell averages", [] {
  return std::make_unique<SectionOf<CellAverages, SwitchSection>>(
      "lagrangian post-processing",
      "Whether mean velocity, granular temperature and solid fraction of every "
      "cell of the mesh are drawn with every picture.");
});

} // namespace
} // namespace eunoe
