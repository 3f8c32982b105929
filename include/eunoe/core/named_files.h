#ifndef eunoe_core_named_files_h
#define eunoe_core_named_files_h

#include <eunoe/core/input_file.h>

#include <mpi.h>

namespace eunoe {

/// SHA-256 of the contents of the files that entries name, instead of their values: they are not
/// part of the input's text. An entry whose files are not there is left out. The first rank reads
/// them; collective.
/// @param entries that name files (`entries_naming_files`)
EntryValues named_files(const EntryValues &entries, MPI_Comm comm);

} // namespace eunoe

#endif
