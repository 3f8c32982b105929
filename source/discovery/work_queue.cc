#include <eunoe/core/gather.h>
#include <eunoe/discovery/simulator.h>
#include <eunoe/discovery/work_queue.h>

#include <algorithm>
#include <vector>

namespace eunoe::discovery {

namespace {

constexpr int tag_ask = 1, tag_answer = 2;
constexpr int none_left = -1;

/// Message of a group that asks for a task.
struct Question
{
  int has_finished, leaves;
};

} // namespace

WorkQueue::WorkQueue(MPI_Comm whole, const unsigned int ranks_per_task)
{
  MPI_Comm_dup(whole, &comm);
  int size;
  MPI_Comm_size(comm, &size);
  MPI_Comm_rank(comm, &rank);
  groups = std::max(1, size / static_cast<int>(std::max(1u, ranks_per_task)));
  const auto group_of = [&](const int r) {
    return static_cast<int>(static_cast<long long>(r) * groups / size);
  };
  MPI_Comm_split(comm, group_of(rank), rank, &group_comm);
  MPI_Comm_rank(group_comm, &group_rank);
  MPI_Comm_size(group_comm, &group_size);
}

WorkQueue::~WorkQueue()
{
  MPI_Comm_free(&group_comm);
  MPI_Comm_free(&comm);
}

void WorkQueue::answer(const int source)
{
  Question question;
  MPI_Recv(&question, 2, MPI_INT, source, tag_ask, comm, MPI_STATUS_IGNORE);
  if (question.leaves != 0) {
    next = n_tasks;
    ++n_dismissed;
    return;
  }
  const int task = next < n_tasks ? next++ : none_left;
  if (task == none_left)
    ++n_dismissed;
  MPI_Send(&task, 1, MPI_INT, source, tag_answer, comm);
  if (question.has_finished != 0)
    on_progress(++n_finished);
}

void WorkQueue::serve()
{
  if (rank != 0 || groups == 1)
    return;
  int waits = 1;
  while (waits != 0) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag_ask, comm, &waits, &status);
    if (waits != 0)
      answer(status.MPI_SOURCE);
  }
}

int WorkQueue::take()
{
  int task = none_left;
  if (rank == 0) {
    if (has_finished)
      on_progress(++n_finished);
    serve();
    task = next < n_tasks ? next++ : none_left;
  } else if (is_leader()) {
    const Question question = {has_finished ? 1 : 0, 0};
    MPI_Send(&question, 2, MPI_INT, 0, tag_ask, comm);
    MPI_Recv(&task, 1, MPI_INT, 0, tag_answer, comm, MPI_STATUS_IGNORE);
  }
  MPI_Bcast(&task, 1, MPI_INT, 0, group_comm);
  has_finished = task != none_left;
  return task;
}

void WorkQueue::run(const int n, const std::function<void(int)> &task,
                    const std::function<void(int)> &progress)
{
  n_tasks = n;
  next = n_finished = n_dismissed = 0;
  has_finished = false;
  on_progress = progress;
  int interrupted = 0;
  try {
    for (int k = take(); k != none_left; k = take())
      task(k);
  } catch (const Interrupted &) {
    interrupted = 1;
    next = n_tasks;
    const Question question = {0, 1};
    if (rank != 0 && is_leader())
      MPI_Send(&question, 2, MPI_INT, 0, tag_ask, comm);
  }
  while (rank == 0 && n_dismissed < groups - 1) {
    MPI_Status status;
    MPI_Probe(MPI_ANY_SOURCE, tag_ask, comm, &status);
    answer(status.MPI_SOURCE);
  }
  MPI_Allreduce(MPI_IN_PLACE, &interrupted, 1, MPI_INT, MPI_MAX, comm);
  if (interrupted != 0)
    throw Interrupted();
}

std::string concatenate(const std::string &mine, MPI_Comm comm)
{
  const std::vector<char> all = gather_all(std::vector<char>(mine.begin(), mine.end()), comm);
  return {all.begin(), all.end()};
}

} // namespace eunoe::discovery
