#ifndef eunoe_discovery_synthetic_data_h
#define eunoe_discovery_synthetic_data_h

#include <eunoe/core/log.h>
#include <eunoe/discovery/catalogue.h>
#include <eunoe/discovery/study_parameters.h>

#include <mpi.h>

namespace eunoe::discovery {

/// Makes synthetic data for a twin experiment: simulates a hidden truth with other seeds, time step
/// and depth than the model's, draws the nuisances, adds noise, and writes the table `measured
/// data` of the study and a sealed file with the truth. Neither file may exist. Throws a UserError
/// on every rank; collective.
/// @param factors effects and nuisances of the study
void make_synthetic_data(const StudyParameters &study, const std::vector<Effect> &factors,
                         MPI_Comm comm, Log &log);

} // namespace eunoe::discovery

#endif
