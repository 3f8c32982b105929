// The reaction to faults of particles, which all ranks decide together, and the warning of contacts
// that are too stiff.
// Reference: half period of an oscillator, pi over the root of stiffness over mass.

#include <eunoe/engine/particle_guard.h>

#include "../tests.h"

using namespace test;

namespace {

constexpr double dt = 1e-3;

/// A guard of the particles 10, 11, ... on the first rank and 20, 21, ... on the second.
struct Trial
{
  explicit Trial(const Domain &domain) : domain(domain), materials({Material()}, 1)
  {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    particles.resize(3, 0, 0);
    for (unsigned int row = 0; row < 3; ++row)
      particles.id[row] = static_cast<ParticleId>(10 + 10 * rank) + row;
  }

  ParticleGuard guard() const { return {parameters, domain, materials, {}, 1., dt}; }
  InspectionResult judge(const Faults &faults) const
  {
    return guard().judge(faults, particles, [this](std::size_t row) {
      return "particle " + std::to_string(particles.id[row]);
    });
  }

  FaultParameters parameters;
  const Domain &domain;
  const Materials materials;
  ParticleArrays particles;
  int rank, n_ranks;
};

} // namespace

EUNOE_MPI_TEST()
{
  Case box(box_input(1e-6, 1e-6, ""));
  Trial trial(box->get_domain());
  const bool is_last = trial.rank + 1 == trial.n_ranks;
  const std::string last = std::to_string(10 * trial.n_ranks);

  InspectionResult result = trial.judge({});
  check("nothing is wrong", !result.stops && !result.warns && result.number == 0);

  // Faults on the last rank only; the particle with the smaller id comes second.
  Faults lost;
  if (is_last)
    lost.lost = {{2, "is lost"}, {0, "is lost, too"}};
  result = trial.judge(lost);
  check("lost ones stop the run", result.stops && !result.warns && result.number == 2);
  check("the smallest id is named", result.first == "particle " + last + " is lost, too",
        result.first);
  trial.parameters.lost_particles = "remove";
  result = trial.judge(lost);
  check("or are taken out with a warning", !result.stops && result.warns && result.number == 2);
  check("where they are", result.lost.size() == (is_last ? 2u : 0u));
  trial.parameters.lost_particles = "ignore";
  result = trial.judge(lost);
  check("or without", !result.stops && !result.warns);

  Faults fast = lost;
  if (trial.rank == 0)
    fast.fast = {{1, "is too fast"}};
  result = trial.judge(fast);
  check("fast ones stop the run in any case", result.stops && result.number == 1);
  check("and are named", result.first == "particle 11 is too fast", result.first);

  Faults squeezed;
  if (trial.rank == 0)
    squeezed.squeezed = {{1, "is squeezed"}, {2, "is squeezed"}};
  ParticleGuard guard = trial.guard();
  const auto judge = [&](const Faults &faults) {
    return guard.judge(faults, trial.particles, [&](std::size_t row) {
      return "particle " + std::to_string(trial.particles.id[row]);
    });
  };
  result = judge(squeezed);
  check("squeezed ones do not stop it", !result.stops && result.squeezed == 2);
  check("but are named", result.first_squeezed == "particle 11 is squeezed", result.first_squeezed);
  if (trial.rank == 0)
    squeezed.squeezed.pop_back();
  result = judge(squeezed);
  check("once", result.squeezed == 1 && result.first_squeezed.empty());
  check("and counted", guard.most_squeezed() == 2);
  trial.parameters.excessive_overlap = "stop";
  result = judge(squeezed);
  check("unless that is wanted", result.stops && result.number == 1);
  check("and named again", result.first == "particle 11 is squeezed", result.first);

  // A half period of about ten steps, on one rank.
  const auto stiffness = [&](double half_period) {
    return is_last ? M_PI * M_PI / (half_period * half_period) : 0.;
  };
  check("no contact", !guard.newly_too_short(0.));
  check("slow enough", !guard.newly_too_short(stiffness(10.01 * dt)));
  const auto found = guard.newly_too_short(stiffness(9.9 * dt));
  check_relative("too stiff", found.value_or(0.), 9.9 * dt, 1e-12);
  check("said once", !guard.newly_too_short(stiffness(5. * dt)));
}
