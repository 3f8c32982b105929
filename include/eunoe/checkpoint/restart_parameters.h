#ifndef eunoe_checkpoint_restart_parameters_h
#define eunoe_checkpoint_restart_parameters_h

#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// `subsection restart`.
struct RestartParameters : public ParameterSection
{
  bool checkpoint = false;
  unsigned long long frequency = 0; ///< steps between checkpoints; 0: by the clock alone
  double minutes = 30.;             ///< of wall-clock time between checkpoints; 0: by steps alone
  unsigned int keep = 2;            ///< number of checkpoints that stay
  std::string filename = "restart";
  std::string restart = "false"; ///< false, true, or auto: if there is a checkpoint
  std::string folder;            ///< with the checkpoint of another run from which this one goes on

  /// Beginning of the names of checkpoints.
  std::string name() const { return filename.substr(filename.rfind('/') + 1); }
  /// Folder of the checkpoints: that of the file name if it has one, else the output folder.
  std::string place(const std::string &output_path) const
  {
    const std::size_t slash = filename.rfind('/');
    return slash == std::string::npos ? output_path : filename.substr(0, slash + 1);
  }

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
