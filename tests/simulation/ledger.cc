// The ledger of particles that came and went is the same after a restart, however many ranks had
// counted them.

#include <eunoe/engine/ledger.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

EUNOE_MPI_TEST()
{
  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Ledger ledger(2);
  for (int k = 0; k <= rank; ++k)
    ledger.inserted.count(0.1);
  ledger.taken_out.count(1e-30);
  ledger.lost.count(1e30);
  ledger.through_outlet[1].count(0.3);

  Ledger continued(2);
  continued.load(nlohmann::ordered_json::parse(ledger.save(MPI_COMM_WORLD).dump()), MPI_COMM_WORLD);
  const auto same = [](const Tally &a, const Tally &b) {
    const Tally x = a.global(MPI_COMM_WORLD), y = b.global(MPI_COMM_WORLD);
    return x.number == y.number && x.mass.words() == y.mass.words();
  };
  check("inserted", same(ledger.inserted, continued.inserted));
  check("taken out", same(ledger.taken_out, continued.taken_out));
  check("lost", same(ledger.lost, continued.lost));
  check("through the first outlet", same(ledger.through_outlet[0], continued.through_outlet[0]));
  check("through the second", same(ledger.through_outlet[1], continued.through_outlet[1]));
  check("as many as were counted", continued.inserted.global(MPI_COMM_WORLD).number ==
                                       static_cast<std::uint64_t>(n_ranks * (n_ranks + 1) / 2));
}
