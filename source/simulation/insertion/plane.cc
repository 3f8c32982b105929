#include <eunoe/core/declare.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/random.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/simulation/insertion.h>
#include <eunoe/solids/box_tree.h>

#include <deal.II/base/mpi.h>

#include "obstacles.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace eunoe {
namespace {

/// The points x with normal . (x - point) = 0.
struct CuttingPlane
{
  Vec3 point, normal = {1., 0., 0.};
};

/// Lethe's "plane": at every event one particle in each empty cell that a plane cuts, where it
/// touches no surface.
class Plane : public Insertion
{
public:
  Plane(const InsertionSettings &settings, const CuttingPlane &plane,
        const PhysicalProperties &physics, MPI_Comm comm)
      : settings(settings), plane(plane), particles(physics.types), comm(comm)
  {
  }

  double largest_diameter() const override { return particles.largest_diameter(); }

  /// At most; how many cells will be empty cannot be known.
  std::size_t supply(std::size_t) const override { return n_all; }

  void skip(std::size_t n, std::size_t n_particles) override
  {
    n_events = n;
    particles.take(n_particles);
  }

  bool finished() const override { return particles.n_remaining() == 0; }

  void check(const Domain &domain, Problems &problems) const override
  {
    const std::vector<Cell> cut = all_of_ranks(find_cells(domain));
    const std::size_t n_cells = cut.size();
    const double distance = closest(cut);
    if (distance < largest_diameter())
      problems.add("subsection 'insertion info' / entry 'insertion method':",
                   "is plane, and the centres of two cells that the plane cuts are " +
                       format(distance) + " m apart, less than the largest diameter of " +
                       format(largest_diameter()) + " m: particles of one event would overlap.",
                   "Take a coarser mesh, smaller particles, or another method.");
    if (n_cells == 0)
      problems.add("subsection 'insertion info' / entry 'insertion plane point':",
                   "the plane cuts no cell of the mesh.",
                   "Move the plane into the mesh, or turn it.");
    else if (settings.frequency == 0 && n_cells < particles.n_remaining())
      problems.add("subsection 'insertion info' / entry 'insertion frequency':",
                   "is 0, so that there is a single event, and the plane cuts " +
                       std::to_string(n_cells) + " cells only for " +
                       std::to_string(particles.n_remaining()) + " particles.",
                   "Set an 'insertion frequency' for several events, or insert fewer.");
  }

  void survey(const Surroundings &surroundings) override
  {
    cells = all_of_ranks(find_cells(surroundings.domain));
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (unsigned int d = 0; d < 3; ++d) {
        const double shift = uniform(settings.seed, Draw::offset, n_events << 32 | c, d) - 0.5;
        cells[c].place[d] +=
            shift * std::min(settings.maximum_offset * largest_diameter(), 2. * cells[c].slack[d]);
      }
    find_free(surroundings);
  }

  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    std::vector<Cell> free;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(free),
                 [](const Cell &cell) { return cell.is_free; });
    const std::size_t n = std::min(free.size(), particles.n_remaining());
    const ParticleId first = ids.take(n);
    const auto [begin, end] = share_of(n, comm);
    std::vector<NewParticle> share;
    for (std::size_t k = begin; k < end; ++k) {
      NewParticle particle = particles.particle(k, first + static_cast<ParticleId>(k));
      particle.position = free[k].place;
      particle.velocity = settings.velocity;
      particle.spin = settings.spin;
      share.push_back(particle);
    }
    particles.take(n);
    ++n_events;
    return share;
  }

private:
  /// A cell that the plane cuts.
  struct Cell
  {
    std::array<double, 4> key; ///< the same on any number of ranks, by which cells are ordered
    Vec3 centre, half;         ///< half the widths of a box, or of the largest one in the cell (m)
    Vec3 slack;                ///< largest shift from a box's centre in each direction (m)
    Vec3 place;                ///< of the particle (m)
    bool is_free = false;
  };

  /// This rank's cells that the plane cuts. A plane along faces cuts the cells behind it.
  std::vector<Cell> find_cells(const Domain &domain) const
  {
    const Vec3 normal = plane.normal / norm(plane.normal);
    const double tolerance = 1e-10 * norm(domain.upper() - domain.lower());
    std::vector<Cell> found;
    for (const auto &cell : domain.mesh().triangulation.active_cell_iterators()) {
      if (!cell->is_locally_owned())
        continue;
      double lowest = 0., highest = 0.;
      for (const unsigned int v : cell->vertex_indices()) {
        const double height = dot(to_vec3(cell->vertex(v)) - plane.point, normal);
        lowest = v == 0 ? height : std::min(lowest, height);
        highest = v == 0 ? height : std::max(highest, height);
      }
      if (lowest >= -tolerance || highest < -tolerance)
        continue;
      Cell cut;
      const auto id = cell->id().to_binary<3>();
      std::copy(id.begin(), id.end(), cut.key.begin());
      cut.centre = cut.place = to_vec3(cell->center());
      for (unsigned int d = 0; d < 3; ++d) {
        cut.half[d] = 0.5 * cell->extent_in_direction(d);
        // In a cell that is no box a particle stays where it surely fits.
        cut.slack[d] =
            domain.mesh().has_boxes ? std::max(0., cut.half[d] - 0.5 * largest_diameter()) : 0.;
      }
      found.push_back(cut);
    }
    return found;
  }

  /// Distance of the two closest centres (m), or the largest diameter where none are closer.
  double closest(const std::vector<Cell> &cut) const
  {
    double least = largest_diameter();
    const Vec3 reach = {least, least, least};
    std::vector<std::pair<Box, std::int32_t>> centres;
    for (const Cell &cell : cut)
      centres.push_back({{cell.centre, cell.centre}, static_cast<std::int32_t>(centres.size())});
    const BoxTree tree(centres);
    for (std::size_t c = 0; c < cut.size(); ++c)
      tree.for_each_meeting({cut[c].centre - reach, cut[c].centre + reach},
                            [&](const std::int32_t other) {
                              const auto o = static_cast<std::size_t>(other);
                              if (o != c)
                                least = std::min(least, norm(cut[o].centre - cut[c].centre));
                            });
    return least;
  }

  /// Those of all ranks, in an order that does not depend on their number.
  std::vector<Cell> all_of_ranks(const std::vector<Cell> &mine) const
  {
    std::vector<Cell> all;
    std::vector<char> bytes(reinterpret_cast<const char *>(mine.data()),
                            reinterpret_cast<const char *>(mine.data() + mine.size()));
    for (const auto &part : dealii::Utilities::MPI::all_gather(comm, bytes)) {
      const std::size_t n = all.size();
      all.resize(n + part.size() / sizeof(Cell));
      std::copy(part.begin(), part.end(), reinterpret_cast<char *>(all.data() + n));
    }
    std::sort(all.begin(), all.end(), [](const Cell &a, const Cell &b) { return a.key < b.key; });
    return all;
  }

  /// A place and its images in the neighbouring periods.
  static std::vector<Vec3> images(const Vec3 &x, const PeriodicBox &box)
  {
    std::vector<Vec3> all = {x};
    for (unsigned int d = 0; d < 3; ++d)
      if (box.length[d] > 0.)
        for (std::size_t n = all.size(), k = 0; k < n; ++k)
          for (const double side : {-1., 1.}) {
            all.push_back(all[k]);
            all.back()[d] += side * box.length[d];
          }
    return all;
  }

  /// Whether a sphere stands in a cell, or touches the largest particle in its place.
  bool takes(const Vec3 &x, double radius, const Cell &cell, const PeriodicBox &box) const
  {
    const Vec3 from_centre = box.shortest(x - cell.centre);
    bool inside = true;
    for (unsigned int d = 0; d < 3; ++d)
      inside = inside && from_centre[d] >= -cell.half[d] && from_centre[d] < cell.half[d];
    const double least = radius + 0.5 * largest_diameter();
    return inside || norm_square(box.shortest(x - cell.place)) < least * least;
  }

  /// Marks the cells in whose place the largest particle would overlap the surface of a solid or a
  /// wall. Whether a place is within a solid is not asked: solids may be vessels.
  void take_where_solids_are(const Surroundings &surroundings, std::vector<int> &taken) const
  {
    // Of the radius: a particle in a corner of its cell touches the walls.
    constexpr double tolerance = 1e-6;
    std::vector<Solid> acting;
    std::copy_if(surroundings.solids.begin(), surroundings.solids.end(), std::back_inserter(acting),
                 [&](const Solid &solid) { return solid.is_active(surroundings.time); });
    const auto [begin, end] = share_of(cells.size(), comm);
    std::vector<Vec3> places;
    for (std::size_t c = begin; c < end; ++c)
      places.push_back(cells[c].place);
    const double radius = 0.5 * largest_diameter();
    Obstacles obstacles(std::move(acting));
    obstacles.search(places, std::vector<double>(places.size(), radius), 0, places.size(), 0.);
    for (std::size_t k = 0; k < places.size(); ++k) {
      double overlap = 0.;
      obstacles.push(k, places[k], radius, overlap);
      if (overlap > tolerance * radius)
        taken[begin + k] = 1;
    }
  }

  void find_free(const Surroundings &surroundings)
  {
    const ParticleArrays &p = surroundings.particles;
    const PeriodicBox &box = surroundings.domain.periods();
    std::vector<std::pair<Box, std::int32_t>> boxes;
    for (std::size_t c = 0; c < cells.size(); ++c)
      boxes.push_back({{cells[c].centre - cells[c].half, cells[c].centre + cells[c].half},
                       static_cast<std::int32_t>(c)});
    const BoxTree tree(boxes);
    std::vector<int> taken(cells.size(), 0);
    for (std::size_t row = 0; row < p.n_owned; ++row) {
      if (surroundings.leaving[row])
        continue;
      const Vec3 x = box.wrap(p.position[row].vec());
      const double radius = p.radius(row), reach = radius + 0.5 * largest_diameter();
      for (const Vec3 &image : images(x, box))
        tree.for_each_meeting(
            {image - Vec3{reach, reach, reach}, image + Vec3{reach, reach, reach}},
            [&](const std::int32_t c) {
              if (takes(x, radius, cells[static_cast<std::size_t>(c)], box))
                taken[static_cast<std::size_t>(c)] = 1;
            });
    }
    take_where_solids_are(surroundings, taken);
    dealii::Utilities::MPI::max(taken, comm, taken);
    for (std::size_t c = 0; c < cells.size(); ++c)
      cells[c].is_free = taken[c] == 0;
  }

  const InsertionSettings settings;
  const CuttingPlane plane;
  ParticleSupply particles;
  const std::size_t n_all = particles.n_remaining(); ///< before the first event
  MPI_Comm comm;
  std::uint64_t n_events = 0;
  std::vector<Cell> cells;
};

class PlaneSection : public InsertionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::vector(prm, "insertion plane point", plane.point, "plane: a point of the plane (m).");
    declare::vector(prm, "insertion plane normal vector", plane.normal,
                    "plane: direction normal to the plane.");
  }

  void check(const InsertionSettings &, const ParameterCheck &check) const override
  {
    check.require(norm(plane.normal) > 0., {InsertionParameters::section},
                  "insertion plane normal vector", "is zero.",
                  "Give the direction normal to the plane.");
  }

  bool needs_cells() const override { return true; }

  std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                  const PhysicalProperties &physics, MPI_Comm comm) const override
  {
    return std::make_unique<Plane>(settings, plane, physics, comm);
  }

private:
  CuttingPlane plane;
};

const InsertionRegistry::Registration registration(insertion_methods(), "plane",
                                                   [] { return std::make_unique<PlaneSection>(); });

} // namespace
} // namespace eunoe
