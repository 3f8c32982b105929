#ifndef eunoe_discovery_work_queue_h
#define eunoe_discovery_work_queue_h

#include <functional>
#include <mpi.h>
#include <string>

namespace eunoe::discovery {

/// Shares out tasks to groups of ranks: a group that is free takes the next task. Rank 0 hands them
/// out beside its own work, so no rank is lost to that.
class WorkQueue
{
public:
  /// Splits @p comm into as many groups of at least @p ranks_per_task ranks as there are;
  /// collective.
  WorkQueue(MPI_Comm comm, unsigned int ranks_per_task);
  ~WorkQueue();
  WorkQueue(const WorkQueue &) = delete;
  WorkQueue &operator=(const WorkQueue &) = delete;

  /// The ranks that work together with this one.
  MPI_Comm group() const { return group_comm; }
  bool is_alone() const { return group_size == 1; }
  /// Whether this rank is the first of its group.
  bool is_leader() const { return group_rank == 0; }
  int n_groups() const { return groups; }

  /// Does tasks 0 to n - 1, each on one group, and calls @p task on all ranks of it. A task may
  /// throw Interrupted, on all ranks of its group: then no others are begun, and all ranks of all
  /// groups throw it when those that run are done. Collective.
  /// @param on_progress called on rank 0 with the number of finished tasks
  void run(int n, const std::function<void(int)> &task,
           const std::function<void(int)> &on_progress);

  /// Answers groups that wait. To be called now and then from within a task.
  void serve();

private:
  int take();
  void answer(int source);

  MPI_Comm comm, group_comm;
  int rank, groups, group_rank, group_size;
  // On rank 0 alone:
  int n_tasks = 0, next = 0, n_finished = 0, n_dismissed = 0;
  bool has_finished = false; ///< whether this group has a finished task to report
  std::function<void(int)> on_progress;
};

/// Texts of all ranks, in their order, the same on every rank; collective.
std::string concatenate(const std::string &mine, MPI_Comm comm);

} // namespace eunoe::discovery

#endif
