#ifndef eunoe_simulation_given_particles_h
#define eunoe_simulation_given_particles_h

#include <eunoe/simulation/measurement.h>
#include <eunoe/state/physical_properties.h>

#include <mpi.h>

namespace eunoe {

/// Reads particles that were not simulated here from a table with the columns x, y, z and diameter
/// or radius (m), and perhaps mass (kg); or of the names that the 'file' insertion reads.
/// Collective. Throws a UserError that says what is wrong and where.
/// @param type has the density of particles without a mass, and the sizes that are expected: other
///   ones are refused
std::vector<GivenParticle> read_given_particles(const std::string &file, const ParticleType &type,
                                                MPI_Comm comm);

} // namespace eunoe

#endif
