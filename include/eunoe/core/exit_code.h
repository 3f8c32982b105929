#ifndef eunoe_core_exit_code_h
#define eunoe_core_exit_code_h

namespace eunoe {

/// Exit codes of the programs.
enum ExitCode
{
  exit_success = 0,
  exit_failure = 1,   ///< the run broke off
  exit_bad_input = 2, ///< the input was refused; nothing was run or written
  exit_stopped = 3,   ///< the run was asked to stop and has left a checkpoint
};

} // namespace eunoe

#endif
