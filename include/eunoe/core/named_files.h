#ifndef eunoe_core_named_files_h
#define eunoe_core_named_files_h

#include <eunoe/core/input_file.h>

#include <mpi.h>

namespace eunoe {

/// The entries of an input that name files, and SHA-256 of the contents of these instead of their
/// values: they are not part of the input's text. The first rank reads them; collective.
/// @param input text of an input file
EntryValues named_files(const std::string &input, MPI_Comm comm);

} // namespace eunoe

#endif
