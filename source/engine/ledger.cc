#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/ledger.h>

namespace eunoe {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Tally &tally)
{
  return {{"number", tally.number}, {"mass", tally.mass.words()}};
}

/// The tally of all ranks on the first one, nothing on the others.
Tally to_tally(const Json &json, MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  // All ranks read it, so that all find what is wrong with it.
  Tally tally;
  tally.number = count_in(json.at("number"));
  tally.mass = exact_sum_in(json.at("mass"));
  return rank == 0 ? tally : Tally();
}

} // namespace

Json Ledger::save(MPI_Comm comm) const
{
  Json saved = {{"inserted", to_json(inserted.global(comm))},
                {"taken_out", to_json(taken_out.global(comm))},
                {"lost", to_json(lost.global(comm))},
                {"through_outlet", Json::array()}};
  for (const Tally &tally : through_outlet)
    saved["through_outlet"].push_back(to_json(tally.global(comm)));
  return saved;
}

void Ledger::load(const Json &saved, MPI_Comm comm)
{
  inserted = to_tally(saved.at("inserted"), comm);
  taken_out = to_tally(saved.at("taken_out"), comm);
  lost = to_tally(saved.at("lost"), comm);
  for (std::size_t o = 0; o < through_outlet.size(); ++o)
    through_outlet[o] = to_tally(saved.at("through_outlet").at(o), comm);
}

} // namespace eunoe
