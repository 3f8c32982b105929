#ifndef eunoe_source_simulation_insertion_packing_h
#define eunoe_source_simulation_insertion_packing_h

#include <eunoe/core/box_parts.h>
#include <eunoe/state/particle_arrays.h>

#include "obstacles.h"

#include <functional>
#include <memory>

namespace eunoe {

/// Where the centres of packed spheres may be.
struct PackingPlace
{
  Vec3 lower, upper; ///< of the box (m)
  PeriodicBox box;
  std::function<double(const Vec3 &)> acceptance; ///< positive where a centre may be
  std::function<bool(const Vec3 &)> holds;        ///< whether a place is in the mesh

  /// Back into the box, where there is no period.
  Vec3 inside(Vec3 x, double radius) const;
  /// The place where a move ends: its aim, or the nearest place that is accepted, or its beginning.
  /// @param step for derivatives of the acceptance (m)
  Vec3 accepted(const Vec3 &from, Vec3 to, double radius, double step) const;
};

/// Spheres that overlap in a box, pushed apart and out of solids until none does.
///
/// Their overlaps are springs, whose energy falls to zero by FIRE (Bitzek, Koskinen, Gaehler,
/// Moseler, Gumbsch 2006), in steps of a pseudo-time. Each rank moves the spheres in its part of
/// the box and knows those around. The forces on a sphere are added in the order of its neighbours'
/// ids, and sums over all spheres are exact; so the result is the same on any number of ranks.
class Packing
{
public:
  struct Sphere
  {
    ParticleId id;
    double radius;           ///< (m)
    Vec3 position, velocity; ///< (m, in a step of the pseudo-time)
  };

  Packing(PackingPlace place, const std::vector<Solid> &solids, MPI_Comm comm);

  /// Packs spheres from random places. Throws a UserError on every rank if no place or no packing
  /// is found; collective.
  /// @param radius of the spheres by id (m)
  /// @param n their number; ids begin with @p first_id
  /// @return the spheres in this rank's part of the box
  std::vector<Sphere> pack(const std::function<double(ParticleId)> &radius, ParticleId first_id,
                           std::size_t n, unsigned int seed);

private:
  /// A random place for a sphere.
  Vec3 draw(ParticleId id, double radius, unsigned int seed) const;
  /// Gives each rank its share of the spheres, at random places, and cuts the box into parts;
  /// collective.
  void scatter(const std::function<double(ParticleId)> &radius, ParticleId first_id, std::size_t n,
               unsigned int seed);
  /// Brings the spheres to the ranks of their parts and lists their neighbours; collective.
  void find_neighbours();
  void take_to_parts();
  void fetch_ghosts(double skin);
  void search_obstacles(double skin);
  /// Brings the places of the ghosts up to date; collective.
  void update_ghosts();
  /// Pushes the spheres apart; collective.
  /// @return whether none overlaps in the end
  bool relax();
  /// Forces on the own spheres (m), with springs of unit stiffness; collective.
  /// @return largest overlap over the sum of the radii, of all
  double compute_forces();
  /// @param worst raised to the largest such overlap
  Vec3 force_on(std::size_t k, double &worst) const;
  /// Moves the own spheres; collective.
  void move(double time_step);

  /// What a neighbouring rank needs and gives.
  struct Link
  {
    int rank = 0;
    std::vector<std::int32_t> sent; ///< own spheres
    std::size_t n_received = 0;     ///< ghosts, which stand behind those of the links before
    std::vector<Vec3> out;
  };

  const PackingPlace place;
  Obstacles obstacles;
  MPI_Comm comm;
  int rank;
  std::unique_ptr<const BoxParts> parts;
  double largest = 0.;         ///< radius (m)
  std::size_t n_own = 0;       ///< behind them stand the ghosts
  std::vector<Sphere> spheres; ///< own ones and ghosts
  std::vector<Vec3> searched, force;
  std::vector<Link> links;
  std::vector<std::vector<std::int32_t>> neighbours; ///< of own spheres, by id
};

} // namespace eunoe

#endif
