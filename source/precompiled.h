#ifndef eunoe_source_precompiled_h
#define eunoe_source_precompiled_h

// Headers of deal.II that most of the files built on it share.

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/particles/particle_handler.h>

#endif
