#ifndef eunoe_simulation_checkpoints_h
#define eunoe_simulation_checkpoints_h

#include <eunoe/checkpoint/checkpoint_store.h>
#include <eunoe/checkpoint/restart_parameters.h>

#include <functional>

namespace eunoe {

class Log;

/// The checkpoints of a run: from which one it continues, when the next is due, and whether the run
/// was asked to stop.
class Checkpoints
{
public:
  Checkpoints(const RestartParameters &parameters, const std::string &output_path, MPI_Comm comm)
      : parameters(parameters), folder(output_path), comm(comm),
        store(output_path, parameters.filename, parameters.keep, comm)
  {
  }

  /// Opens the one from which the run is to continue, if there is one; collective.
  /// @param input complete text of the present input
  /// @param n_steps of the run
  void find(const std::string &input, unsigned long long n_steps, Log &log, Problems &problems);
  /// The one that was opened, null if the run begins anew.
  const Checkpoint *opened() const { return checkpoint.get(); }
  /// Lets @p action read the head of the one that was opened, which is the same on every rank, and
  /// refuses it if it is not what it should be.
  void understand(const std::function<void(const nlohmann::ordered_json &head)> &action) const;

  /// Starts to watch signals and the time, if checkpoints are written at all.
  void begin();
  /// Goes on behind the one that was opened, which has been read.
  void go_on() { store.go_on(); }
  void close() { checkpoint.reset(); }

  /// Whether one is due after a step; collective.
  bool is_due(unsigned long long step);
  /// Whether the last `is_due` found that the run was asked to stop.
  bool is_stopped() const { return signal != 0; }
  /// Writes one and says so if it is the last; collective.
  void write(CheckpointWriter &writer, unsigned long long step, Log &log);

  /// Where the state goes when the run stops for a fault.
  std::string fault_file() const { return parameters.filename + "_fault.checkpoint"; }

private:
  const RestartParameters &parameters;
  const std::string folder;
  MPI_Comm comm;
  CheckpointStore store;
  std::unique_ptr<Checkpoint> checkpoint;
  double last_time = 0.; ///< by the wall clock (s)
  int signal = 0;        ///< that asked the run to stop; 0: none
};

} // namespace eunoe

#endif
