#include <eunoe/contact/contact_rows.h>

#include <algorithm>
#include <numeric>

namespace eunoe {

void ContactRows::add(const Record &record)
{
  values.push_back(record.with_solid ? 1. : 0.);
  values.push_back(record.partner);
  if (record.with_solid)
    values.insert(values.end(), {record.normal.x, record.normal.y, record.normal.z});
  values.insert(values.end(), record.history, record.history + n_history);
  starts.back() = values.size();
}

std::vector<ContactRows::Record> ContactRows::records(const std::size_t row) const
{
  std::vector<Record> list;
  for (std::size_t at = starts[row]; at < starts[row + 1];) {
    const double *const r = &values[at];
    Record record{r[0] != 0., static_cast<std::uint32_t>(r[1]), {}, r + 2};
    if (record.with_solid) {
      record.normal = {r[2], r[3], r[4]};
      record.history += 3;
    }
    list.push_back(record);
    at += length(r);
  }
  return list;
}

void ContactRows::collect(const ParticleArrays &particles, const PairList &pairs,
                          const SolidContacts &solids)
{
  const auto n_owned = static_cast<std::int32_t>(particles.n_owned);
  const std::size_t pair_length = 2 + n_history, solid_length = 5 + n_history;
  starts.assign(n_owned + 1, 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs.record[k] != ContactMemory::none)
      for (const std::int32_t p : {pairs.i[k], pairs.j[k]})
        if (p < n_owned)
          starts[p + 1] += pair_length;
  for (const auto &candidate : solids.get_candidates())
    starts[candidate.particle + 1] += candidate.n_living * solid_length;
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  values.resize(starts.back());

  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs.record[k] != ContactMemory::none)
      for (const std::int32_t p : {pairs.i[k], pairs.j[k]})
        if (p < n_owned) {
          double *const r = &values[next[p]];
          r[0] = 0.;
          r[1] = particles.id[p == pairs.i[k] ? pairs.j[k] : pairs.i[k]];
          std::copy_n(pairs.memory[pairs.record[k]], n_history, r + 2);
          next[p] += pair_length;
        }
  for (const auto &candidate : solids.get_candidates())
    for (unsigned int l = 0; l < candidate.n_living; ++l) {
      const std::int32_t living = candidate.living[l];
      double *const r = &values[next[candidate.particle]];
      const Vec3 &normal = solids.normal(living);
      r[0] = 1.;
      r[1] = candidate.solid;
      r[2] = normal.x;
      r[3] = normal.y;
      r[4] = normal.z;
      std::copy_n(solids.history(living), n_history, r + 5);
      next[candidate.particle] += solid_length;
    }
}

void ContactRows::attach(const ParticleArrays &particles, PairList &pairs,
                         SolidContacts &solids) const
{
  const auto n_owned = static_cast<std::int32_t>(particles.n_owned);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const bool has_i = pairs.i[k] < n_owned;
    const std::int32_t row = has_i ? pairs.i[k] : pairs.j[k];
    const auto partner = static_cast<double>(particles.id[has_i ? pairs.j[k] : pairs.i[k]]);
    for (std::size_t at = starts[row]; at < starts[row + 1]; at += length(&values[at]))
      if (values[at] == 0. && values[at + 1] == partner) {
        pairs.record[k] = pairs.memory.create();
        std::copy_n(&values[at + 2], n_history, pairs.memory[pairs.record[k]]);
        break;
      }
  }
  for (std::int32_t row = 0; row < n_owned; ++row)
    for (std::size_t at = starts[row]; at < starts[row + 1]; at += length(&values[at]))
      if (values[at] != 0.)
        solids.restore(row, static_cast<std::int32_t>(values[at + 1]),
                       {values[at + 2], values[at + 3], values[at + 4]}, &values[at + 5]);
}

ContactRows ContactRows::fetch(const std::vector<Origin> &origins, MPI_Comm comm) const
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);

  // Ask every rank for the rows that it kept: first how many, then which, then their contents.
  std::vector<std::vector<int>> wanted(n_ranks);
  for (const Origin &origin : origins)
    if (origin.rank >= 0 && origin.rank != rank)
      wanted[origin.rank].push_back(origin.row);
  std::vector<int> n_wanted(n_ranks), n_asked(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    n_wanted[r] = static_cast<int>(wanted[r].size());
  MPI_Alltoall(n_wanted.data(), 1, MPI_INT, n_asked.data(), 1, MPI_INT, comm);

  constexpr int tag_rows = 301, tag_lengths = 302, tag_values = 303;
  std::vector<MPI_Request> requests;
  const auto wait = [&requests]() {
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
  };
  const auto send = [&](const void *data, std::size_t n, MPI_Datatype type, int to, int tag) {
    requests.emplace_back();
    MPI_Isend(data, static_cast<int>(n), type, to, tag, comm, &requests.back());
  };
  const auto receive = [&](void *data, std::size_t n, MPI_Datatype type, int from, int tag) {
    requests.emplace_back();
    MPI_Irecv(data, static_cast<int>(n), type, from, tag, comm, &requests.back());
  };

  std::vector<std::vector<int>> asked(n_ranks), lengths_out(n_ranks), lengths_in(n_ranks);
  std::vector<std::vector<double>> values_out(n_ranks), values_in(n_ranks);
  for (int r = 0; r < n_ranks; ++r) {
    asked[r].resize(n_asked[r]);
    if (n_asked[r] > 0)
      receive(asked[r].data(), n_asked[r], MPI_INT, r, tag_rows);
    if (n_wanted[r] > 0)
      send(wanted[r].data(), n_wanted[r], MPI_INT, r, tag_rows);
  }
  wait();
  for (int r = 0; r < n_ranks; ++r) {
    for (const int row : asked[r]) {
      lengths_out[r].push_back(static_cast<int>(starts[row + 1] - starts[row]));
      values_out[r].insert(values_out[r].end(), values.begin() + starts[row],
                           values.begin() + starts[row + 1]);
    }
    lengths_in[r].resize(n_wanted[r]);
    if (n_wanted[r] > 0)
      receive(lengths_in[r].data(), n_wanted[r], MPI_INT, r, tag_lengths);
    if (n_asked[r] > 0)
      send(lengths_out[r].data(), n_asked[r], MPI_INT, r, tag_lengths);
  }
  wait();
  for (int r = 0; r < n_ranks; ++r) {
    values_in[r].resize(
        std::accumulate(lengths_in[r].begin(), lengths_in[r].end(), std::size_t(0)));
    if (!values_in[r].empty())
      receive(values_in[r].data(), values_in[r].size(), MPI_DOUBLE, r, tag_values);
    if (!values_out[r].empty())
      send(values_out[r].data(), values_out[r].size(), MPI_DOUBLE, r, tag_values);
  }
  wait();

  ContactRows rows(n_history);
  rows.starts.reserve(origins.size() + 1);
  std::vector<std::size_t> next_row(n_ranks, 0), next_value(n_ranks, 0);
  for (const Origin &origin : origins) {
    if (origin.rank == rank)
      rows.values.insert(rows.values.end(), values.begin() + starts[origin.row],
                         values.begin() + starts[origin.row + 1]);
    else if (origin.rank >= 0) {
      const int r = origin.rank;
      const int n = lengths_in[r][next_row[r]++];
      rows.values.insert(rows.values.end(), values_in[r].begin() + next_value[r],
                         values_in[r].begin() + next_value[r] + n);
      next_value[r] += n;
    }
    rows.starts.push_back(rows.values.size());
  }
  return rows;
}

} // namespace eunoe
