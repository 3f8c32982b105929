#ifndef eunoe_processes_common_checks_h
#define eunoe_processes_common_checks_h

#include <eunoe/simulation/parameters.h>

namespace eunoe {

/// Notes a problem unless there is one particle type.
/// @param who begins a sentence: "The heap"
void require_one_type(const Parameters &parameters, const ParameterCheck &check,
                      const std::string &who);

/// Notes a problem unless gravity points to -y.
/// @param why it must
void check_gravity_of_process(const Parameters &parameters, const ParameterCheck &check,
                              const std::string &why);

/// Notes a problem if the user decides what a process decides: mesh, boundaries, insertion, end.
/// @param end completes the sentence "The process ends when ..."
/// @param bound says what rules the length of the run instead
void refuse_decisions_of_process(const ParameterCheck &check, const std::string &end,
                                 const std::string &bound);

} // namespace eunoe

#endif
