#ifndef eunoe_discovery_twin_h
#define eunoe_discovery_twin_h

#include <eunoe/core/log.h>
#include <eunoe/discovery/catalogue.h>
#include <eunoe/discovery/study_parameters.h>

#include <mpi.h>

namespace eunoe::discovery {

/// Makes data of a hidden truth: simulates it with other seeds, time step and depth than the
/// model's, draws the nuisances, adds noise, and writes the table `measured data` of the study and
/// the truth, sealed. Neither file may exist. Throws a UserError on every rank; collective.
/// @param factors effects and nuisances of the study
void make_twin(const StudyParameters &study, const std::vector<Effect> &factors, MPI_Comm comm,
               Log &log);

} // namespace eunoe::discovery

#endif
