// What a run needs of the machine: memory, room on the disk, time.

#include <eunoe/core/files.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/quoted_text.h>

#include "judgements.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace eunoe {

namespace {

/// Bytes of a particle of a settled bed with its share of the mesh, and of a rank without them, as
/// measured (doc/performance.md).
constexpr double bytes_per_particle = 1400., bytes_per_rank = 1.7e8;
/// Of a particle and of each of its further fields in a picture, and of a particle in a checkpoint
/// (doc/restart.md).
constexpr double picture_bytes_per_particle = 60., picture_bytes_per_field = 4.,
                 checkpoint_bytes_per_particle = 1000.;
constexpr double many_pictures = 1e5, many_steps = 1e11;

/// Number of times at which pictures are written.
double number_of_pictures(const ControlParameters &control, const double steps)
{
  const double duration = steps * control.time_step;
  const double interval = control.output_control == "time"
                              ? control.output_time
                              : control.output_frequency * control.time_step;
  const double begin = std::max(0., control.output_window[0]),
               end = std::min(duration, control.output_window[1]);
  if (!(interval > 0.) || end < begin)
    return 0.;
  return std::floor(end / interval + 1e-6) - std::ceil(begin / interval - 1e-6) + 1.;
}

void judge_memory(const RunEstimate &estimate, MPI_Comm comm, Forecast &forecast)
{
  int n_ranks, n_here;
  MPI_Comm_size(comm, &n_ranks);
  MPI_Comm node;
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, &n_here);
  MPI_Comm_free(&node);
  const double of_run = estimate.most_particles * bytes_per_particle;
  const double here = of_run * n_here / n_ranks + n_here * bytes_per_rank;
  const double there_is = usable_memory();
  forecast.facts.push_back("Memory: about " + format_bytes(of_run) + " for " +
                           format_count(estimate.most_particles, "particle", "particles") +
                           ", and 170 MB a rank; this machine has " + format_bytes(there_is));
  double lack = there_is > 0. && here > there_is ? here - there_is : 0.;
  MPI_Allreduce(MPI_IN_PLACE, &lack, 1, MPI_DOUBLE, MPI_MAX, comm);
  if (lack > 0.)
    forecast.problems.warn(
        "Memory:", "the run needs about " + format_bytes(lack) + " more than this machine has.",
        "Run it on a larger machine or on more of them, or make the case "
        "smaller.");
}

void judge_disk(const Parameters &parameters, const RunEstimate &estimate,
                const unsigned int n_extra, MPI_Comm comm, Forecast &forecast)
{
  const ControlParameters &control = parameters.control;
  const double n_regular = number_of_pictures(control, estimate.steps);
  const double n = n_regular + estimate.pictures;
  const double pictures =
      n * estimate.particles * (picture_bytes_per_particle + n_extra * picture_bytes_per_field);
  const RestartParameters &restart = parameters.restart;
  // A new checkpoint is complete before the oldest is removed.
  const double checkpoints = restart.checkpoint ? (restart.keep + 1.) * estimate.most_particles *
                                                      (checkpoint_bytes_per_particle + 8. * n_extra)
                                                : 0.;
  forecast.facts.push_back(
      "Disk: " +
      (n > 0. ? format_count(n, "picture", "pictures") + " of about " + format_bytes(pictures) +
                    " in all"
              : std::string("no pictures, as 'output frequency' is 0 or none is due")) +
      (restart.checkpoint ? ", checkpoints of about " + format_bytes(checkpoints)
                          : std::string(", no checkpoints")) +
      "; results go to " + shortened(control.output_path));
  int rank;
  MPI_Comm_rank(comm, &rank);
  const double room = rank == 0 ? free_disk_space(control.output_path) : 0.;
  double lack = room > 0. ? pictures + checkpoints - room : 0.;
  MPI_Bcast(&lack, 1, MPI_DOUBLE, 0, comm);
  if (lack > 0.)
    forecast.problems.warn("subsection 'simulation control' / entry 'output path':",
                           "the disk lacks about " + format_bytes(lack) +
                               " for pictures and checkpoints.",
                           "Free some room, write fewer pictures, or choose another disk.");
  if (n_regular > many_pictures)
    forecast.problems.warn(
        "subsection 'simulation control' / entry '" +
            std::string(control.output_control == "time" ? "output time" : "output frequency") +
            "':",
        format_whole(n_regular) + " pictures would be written.",
        "Raise it; a few hundred are enough for a film.");
}

/// Whether the output folder could be written to, which the run finds when it creates it.
void judge_folder(const Parameters &parameters, MPI_Comm comm, Forecast &forecast)
{
  const std::string &path = parameters.control.output_path;
  int rank;
  MPI_Comm_rank(comm, &rank);
  std::string obstacle;
  int has_results = 0;
  if (rank == 0) {
    obstacle = obstacle_to_folder(path);
    std::error_code failure;
    has_results = std::filesystem::exists(path + "/used.prm", failure) ? 1 : 0;
  }
  obstacle = broadcast(obstacle, comm);
  MPI_Bcast(&has_results, 1, MPI_INT, 0, comm);
  if (!obstacle.empty())
    forecast.problems.add("subsection 'simulation control' / entry 'output path':",
                          "the folder " + shortened(path) + " cannot be written to: " + obstacle +
                              ".",
                          "Choose another folder, or mend the permissions.");
  if (has_results != 0 && parameters.restart.restart == "false")
    forecast.facts.push_back("The folder " + shortened(path) +
                             " holds results of an earlier run, which are written over.");
}

} // namespace

void judge_resources(const Parameters &parameters, const RunEstimate &estimate, MPI_Comm comm,
                     Forecast &forecast)
{
  judge_memory(estimate, comm, forecast);
  const bool by_number = parameters.control.end_control == "iteration";
  if (estimate.steps > many_steps)
    forecast.problems.warn("subsection 'simulation control' / entry '" +
                               std::string(by_number ? "iteration end" : "time end") + "':",
                           "the run would take " + format_whole(estimate.steps) + " steps.",
                           "Shorten it, or raise the time step.");
}

void judge_output(const Parameters &parameters, const RunEstimate &estimate,
                  const unsigned int n_extra, MPI_Comm comm, Forecast &forecast)
{
  judge_disk(parameters, estimate, n_extra, comm, forecast);
  judge_folder(parameters, comm, forecast);
}

} // namespace eunoe
