#include <eunoe/engine/contact_rows.h>
#include <eunoe/state/new_particle.h>

#include <algorithm>
#include <numeric>

namespace eunoe {

void ContactRows::add(const Record &record)
{
  rows.values.push_back(record.with_solid ? 1. : 0.);
  rows.values.push_back(record.partner);
  if (record.with_solid)
    rows.values.insert(rows.values.end(), {record.normal.x, record.normal.y, record.normal.z});
  rows.values.insert(rows.values.end(), record.history, record.history + n_history);
  rows.starts.back() = rows.values.size();
}

std::vector<ContactRows::Record> ContactRows::records(const std::size_t row) const
{
  const auto &[starts, values] = rows;
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

bool ContactRows::are_records(const double *begin, const double *const end,
                              const unsigned int n_history)
{
  while (begin != end) {
    const bool with_solid = begin[0] != 0.;
    const std::ptrdiff_t length = (with_solid ? 5 : 2) + static_cast<std::ptrdiff_t>(n_history);
    if (end - begin < length || !is_number_below(begin[1], with_solid ? 0x1p31 : 0x1p32))
      return false;
    begin += length;
  }
  return true;
}

void ContactRows::collect(const ParticleArrays &particles, const PairList &pairs,
                          const SolidContacts &solids)
{
  const auto n_owned = static_cast<std::int32_t>(particles.n_owned);
  const std::size_t pair_length = 2 + n_history, solid_length = 5 + n_history;
  auto &[starts, values] = rows;
  starts.assign(n_owned + 1, 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs.record[k] != ContactMemory::none)
      for (const std::int32_t p : {pairs.i[k], pairs.j[k]})
        if (p < n_owned)
          starts[p + 1] += pair_length;
  for (const auto &candidate : solids.get_candidates())
    starts[candidate.particle + 1] += candidate.n_living * solid_length;
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  if (starts.back() > values.capacity()) {
    // Without this the vector would grow to twice the size, and copy values that are overwritten
    // anyway.
    values = {};
    values.reserve(starts.back() + starts.back() / 16);
  }
  values.resize(starts.back());

  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs.record[k] != ContactMemory::none)
      for (const std::int32_t p : {pairs.i[k], pairs.j[k]})
        if (p < n_owned) {
          double *const r = &values[next[p]];
          r[0] = 0.;
          r[1] = particles.id[p == pairs.i[k] ? pairs.j[k] : pairs.i[k]];
          pairs.memory.read(pairs.record[k], r + 2);
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

void ContactRows::attach(const RowViews &views, const ParticleArrays &particles, PairList &pairs,
                         SolidContacts &solids) const
{
  const auto n_owned = static_cast<std::int32_t>(particles.n_owned);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const bool has_i = pairs.i[k] < n_owned;
    const std::int32_t row = has_i ? pairs.i[k] : pairs.j[k];
    const auto partner = static_cast<double>(particles.id[has_i ? pairs.j[k] : pairs.i[k]]);
    for (const double *r = views[row]; r != views.end(row); r += length(r))
      if (r[0] == 0. && r[1] == partner) {
        pairs.record[k] = pairs.memory.create();
        pairs.memory.write(pairs.record[k], r + 2);
        break;
      }
  }
  for (std::int32_t row = 0; row < n_owned; ++row)
    for (const double *r = views[row]; r != views.end(row); r += length(r))
      if (r[0] != 0.)
        solids.restore(row, static_cast<std::int32_t>(r[1]), {r[2], r[3], r[4]}, r + 5);
}

} // namespace eunoe
