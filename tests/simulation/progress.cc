// When the progress of a run is reported, and what is counted of its work.

#include <eunoe/simulation/progress.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

EUNOE_MPI_TEST()
{
  Log log(MPI_COMM_WORLD, true);
  Progress progress(log, 10);
  check("every ten steps", progress.is_report_due(10, false) && !progress.is_report_due(11, false));
  check("at the end", progress.is_report_due(11, true));
  Clock clock(1., 20);
  for (unsigned int step = 0; step < 20; ++step) {
    clock.advance();
    progress.count_step(100, step < 10 ? 50 : 0);
  }
  progress.report(clock, 100, clock.share(), "");
  check("not twice", !progress.is_report_due(20, true));

  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  check_close("steps of particles", progress.particle_steps(), 2000., 0.);
  check_close("share asleep", progress.share_asleep(MPI_COMM_WORLD), 0.25 * n_ranks, 0.);
  check_close("no speed without a loop", progress.particle_steps_per_second(), 0., 0.);
  nlohmann::ordered_json summary;
  progress.add_times(summary, MPI_COMM_WORLD);
  check("a time for every part, and that of the slowest rank", summary.size() == 2 * Timers::n);
}
