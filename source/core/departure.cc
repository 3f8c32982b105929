#include <eunoe/core/departure.h>
#include <eunoe/core/exit_code.h>
#include <eunoe/core/log.h>
#include <eunoe/core/message_tags.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

namespace eunoe {

namespace {

/// Largest time for a message, and for a rank to print the reason and end all (s).
constexpr double time_for_messages = 1., time_to_end = 10.;

/// Polls, and sleeps in between to leave the processor to ranks that work.
bool wait_for(const double seconds, const std::function<bool()> &is_done)
{
  const double end = MPI_Wtime() + seconds;
  while (!is_done()) {
    if (MPI_Wtime() > end)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

} // namespace

Departure::Departure(MPI_Comm comm_)
{
  MPI_Comm_dup(comm_, &comm);
}

Departure::~Departure()
{
  MPI_Comm_free(&comm);
}

bool Departure::meet(const double patience) const
{
  MPI_Request request;
  MPI_Ibarrier(comm, &request);
  return wait_for(patience, [&request] {
    int done;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  });
}

bool Departure::is_preceded() const
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  for (int later = rank + 1; later < n_ranks; ++later) {
    MPI_Request request;
    MPI_Isend(nullptr, 0, MPI_BYTE, later, tag_departure, comm, &request);
    MPI_Request_free(&request);
  }
  return wait_for(time_for_messages, [this] {
    int is_there;
    MPI_Iprobe(MPI_ANY_SOURCE, tag_departure, comm, &is_there, MPI_STATUS_IGNORE);
    return is_there != 0;
  });
}

void Departure::leave(const std::string &sentence, const double patience) const
{
  if (meet(patience)) {
    Log(comm).error(sentence);
    return;
  }
  if (is_preceded())
    // The earlier rank prints the reason and ends all.
    wait_for(time_to_end, [] { return false; });
  else
    std::fprintf(stderr, "%s\n", sentence.c_str());
  std::fflush(stderr);
  MPI_Abort(comm, exit_failure);
}

} // namespace eunoe
