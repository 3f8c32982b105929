# Settings for all tests; ctest reads this file before it runs them.

# Where tests in Python find modules. By hand: PYTHONPATH=contrib:tests tests/.../test.py ...
set(ENV{PYTHONPATH} "${CMAKE_CURRENT_LIST_DIR}/../contrib:${CMAKE_CURRENT_LIST_DIR}")

# Open MPI starts in half the time without a search for fast networks.
set(ENV{OMPI_MCA_pml} ob1)
# When a rank has ended with an error, the launcher does not give the others two seconds to end, too:
# they have said what they have to say before the first ends.
set(ENV{OMPI_MCA_odls_base_sigkill_timeout} 0)
# All ranks share a node, so they need no network: Open MPI 5 complains, in the output, of those that it cannot
# use, and libfabric (ofi) waits for more than a second at each start. This replaces what the system's
# openmpi-mca-params.conf leaves out, so all are named.
set(ENV{OMPI_MCA_btl} ^tcp,ofi,openib,uct,usnic)
# Tests have more ranks than some machines have cores. A rank that waits leaves its core to others.
# The first name is that of Open MPI 4, the second that of Open MPI 5.
set(ENV{OMPI_MCA_rmaps_base_oversubscribe} 1)
set(ENV{PRTE_MCA_rmaps_default_mapping_policy} :oversubscribe)
set(ENV{OMPI_MCA_mpi_yield_when_idle} 1)
