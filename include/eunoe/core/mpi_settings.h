#ifndef eunoe_core_mpi_settings_h
#define eunoe_core_mpi_settings_h

namespace eunoe {

/// Settings of the MPI library that the programs rely on, as far as the environment does not have
/// them; to be called before MPI starts.
void choose_mpi_settings();

} // namespace eunoe

#endif
