#ifndef eunoe_simulation_checkpoints_h
#define eunoe_simulation_checkpoints_h

#include <eunoe/checkpoint/checkpoint_store.h>
#include <eunoe/checkpoint/restart_parameters.h>
#include <eunoe/core/input_file.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/run_lock.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <limits>

namespace eunoe {

class Log;
struct ControlParameters;

/// The checkpoints of a run: from which one it continues, when the next is due, and whether the run
/// was asked to stop.
class Checkpoints
{
public:
  Checkpoints(const RestartParameters &parameters, const std::string &output_path, MPI_Comm comm);
  ~Checkpoints();

  /// Says what forbids to go on with another input.
  /// @param head of the checkpoint
  using PhaseJudge = std::function<void(const Problems &differences,
                                        const nlohmann::ordered_json &head, Problems &problems)>;

  /// Opens the one from which the run is to continue, if there is one; collective.
  /// @param input all entries of the present input
  /// @param changed its entries that do not have their defaults
  /// @param naming_files its entries that name files which the run reads
  /// @param control says when the run ends
  void find(const EntryValues &input, const EntryValues &changed, const EntryValues &naming_files,
            const ControlParameters &control, const PhaseJudge &judge, Log &log,
            Problems &problems);
  /// The one that was opened, null if the run begins anew.
  const Checkpoint *opened() const { return checkpoint.get(); }
  /// Whether it is of a run with another input.
  bool begins_phase() const { return is_other_input; }
  /// Whether its results lie in the output folder, where they are continued.
  bool is_own() const { return has_own_results; }
  /// Of the one that was opened (s).
  double time() const;
  /// Lets @p action read the head of the one that was opened, which is the same on every rank, and
  /// refuses it if it is not what it should be.
  void understand(const std::function<void(const nlohmann::ordered_json &head)> &action) const;

  /// Keeps other runs from writing checkpoints of the same name into the same folder, if they are
  /// written at all. Throws a UserError on every rank if another run writes there; collective.
  /// @return why others are not kept out, on the first rank; empty if they are
  std::string occupy();
  /// Refuses to continue where another run has written checkpoints since `find`, which this one
  /// would drop; to be called when others are kept out. Throws a UserError on every rank;
  /// collective.
  void check_newest() const;
  /// Makes the folder of the checkpoints and starts to watch signals and the time, if checkpoints
  /// are written at all; collective.
  void begin();
  /// Goes on behind the one that was opened, which has been read.
  void go_on()
  {
    if (!is_own_folder)
      return;
    if (is_other_input)
      store.keep_opened();
    store.go_on();
    goes_on = true;
  }
  /// Keeps a later run from going on from what is there of an earlier run, unless this one does so
  /// itself; collective.
  void begin_results()
  {
    if (parameters.checkpoint && !goes_on)
      store.begin_anew();
  }
  void close();

  /// Whether one is due after a step; collective.
  bool is_due(unsigned long long step);
  /// Whether one is due as the run ends, with no step left to make.
  bool is_due_at_end(unsigned long long step) const
  {
    return parameters.checkpoint && step != last_step;
  }
  /// Whether the last `is_due` found that the run was asked to stop.
  bool is_stopped() const { return signal != 0; }
  /// Writes one and says so if it is the last; collective.
  void write(CheckpointWriter &writer, unsigned long long step, Log &log);

  /// Where the state goes when the run stops for a fault.
  std::string fault_file() const { return parameters.name() + "_fault.checkpoint"; }

private:
  /// Opens the newest in the output folder, else one of another run; collective.
  void open(Log &log);
  /// Folders beside the output folder and in the present one that hold checkpoints of the name.
  std::vector<std::string> folders_nearby() const;

  const RestartParameters &parameters;
  const std::string folder;
  MPI_Comm comm;
  CheckpointStore store;
  std::unique_ptr<Checkpoint> checkpoint;
  std::unique_ptr<RunLock> lock;
  EntryValues files; ///< digests of those that the input names
  bool is_other_input = false, is_own_folder = true, has_own_results = true;
  bool goes_on = false;  ///< behind a checkpoint of its folder
  double last_time = 0.; ///< by the wall clock (s)
  /// Of the one that was opened or written last.
  unsigned long long last_step = std::numeric_limits<unsigned long long>::max();
  int signal = 0; ///< that asked the run to stop; 0: none
};

} // namespace eunoe

#endif
