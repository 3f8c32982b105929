#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/input_file.h>
#include <eunoe/simulation/simulation.h>
#include <eunoe/solids/crossings.h>

#include <algorithm>

namespace eunoe {

void check_places(const Domain &domain, const std::vector<Vec3> &places, MPI_Comm comm,
                  Problems &problems)
{
  unsigned long long outside = 0;
  for (const Vec3 &x : places)
    outside += domain.contains(x) ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &outside, 1, MPI_UNSIGNED_LONG_LONG, MPI_MAX, comm);
  if (outside > 0)
    problems.add("subsection 'insertion info':",
                 "particles are to be inserted outside the mesh, " + std::to_string(outside) +
                     " or more.",
                 "Enlarge the mesh, or correct the places.");
}

void check_crossings(const std::vector<Solid> &solids, const std::size_t n_given,
                     Problems &problems)
{
  const auto surface = [](const Solid &solid) {
    const RigidState state = solid.motion->at(0.);
    std::vector<Vec3> corners = solid.shape->triangles();
    for (Vec3 &x : corners)
      x = state.centre + state.rotation.apply(x);
    return corners;
  };
  for (std::size_t a = 0; a < n_given; ++a) {
    const std::vector<Vec3> given = surface(solids[a]);
    for (std::size_t b = n_given; b < solids.size(); ++b) {
      constexpr double tolerance = 1e-9;
      Vec3 where;
      if (surfaces_cross(given, surface(solids[b]), tolerance, where))
        problems.add("subsection 'solid objects':",
                     "'" + solids[a].name + "' passes through the '" + solids[b].name + "' at (" +
                         format(where.x) + ", " + format(where.y) + ", " + format(where.z) + ") m.",
                     "Move it or make it smaller.");
    }
  }
}

void check_domain(const Domain &domain, const Parameters &parameters, const double reach,
                  Problems &problems)
{
  for (unsigned int d = 0; d < 3; ++d)
    if (domain.periods().is_periodic(d) && domain.periods().length[d] < 2. * reach)
      problems.add("subsection 'DEM boundary conditions':",
                   "the period of " + format(domain.periods().length[d]) + " m in direction " +
                       std::to_string(d) + " is less than twice the " + format(reach) +
                       " m within which contacts are searched at least, so that two particles "
                       "could touch on both sides.",
                   "Make the domain longer in that direction.");
  const std::vector<BoundaryCondition> &conditions = parameters.boundaries.conditions;
  if (domain.moves() &&
      (parameters.process_name != "none" || parameters.insertion.chosen().needs_cells() ||
       std::any_of(conditions.begin(), conditions.end(), [](const BoundaryCondition &c) {
         return c.type != "fixed_wall" && c.type != "outlet";
       })))
    problems.add("subsection 'grid motion' / entry 'motion type':",
                 "a mesh that moves has walls and outlets only, no surfaces that move in place nor "
                 "periodic ones, and neither a process nor insertion by 'plane'.",
                 "Give 'none', or take these out.");
}

void check_phase(const Parameters &parameters, const Problems &differences,
                 const nlohmann::ordered_json &head, Problems &problems)
{
  // Particles come type by type, and a checkpoint knows how many have come in all.
  const std::size_t n_types = parameters.physics.types.size();
  const bool have_come = count_in(head.at("insertion").at("supplied")) > 0;
  for (std::size_t k = 0; have_come && k + 1 < n_types; ++k) {
    const std::string entry =
        describe({"lagrangian physical properties", "particle type " + std::to_string(k)},
                 "number of particles");
    for (const Problem &difference : differences.all())
      if (difference.where == entry)
        problems.add(difference.where, difference.what,
                     "Keep it, and give further particles as a type behind the others.");
  }
  if (parameters.process() == nullptr)
    return;
  std::vector<Problem> of_process;
  for (const Problem &difference : differences.all())
    if (difference.where.find(describe({}, "process")) == 0) {
      problems.add(difference.where, difference.what, difference.mend);
      return;
    } else if (difference.where.find(describe({parameters.process_name}, "")) == 0)
      of_process.push_back(difference);
  const ProcessSection &process = *parameters.process();
  if (!of_process.empty())
    process.check_phase(of_process, head, problems);
  else if (process.is_done(head))
    problems.add(
        describe({parameters.process_name}, ""),
        "is that of the checkpoint, whose run has done all of it, so that nothing would be "
        "simulated with what differs now.",
        "Start anew with 'restart = false', or give the process more to do if it can.");
}

} // namespace eunoe
