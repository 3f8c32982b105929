#include "particle_store_implementation.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace eunoe {

ParticleStore::ParticleStore(const Domain &domain, const double least_width, const double reach,
                             const unsigned int n_extra, const std::optional<FieldHandle> asleep)
    : implementation(std::make_unique<Implementation>(domain, least_width, reach, n_extra, asleep))
{
}

ParticleStore::~ParticleStore() = default;

void ParticleStore::set_reach(const double reach)
{
  implementation->reach = reach;
  implementation->near_cell = implementation->forest.foreign_neighbours(reach);
}

std::uint64_t ParticleStore::n_global() const
{
  return implementation->handler.n_global_particles() - implementation->n_left_out;
}

std::uint64_t ParticleStore::n_cells() const
{
  return implementation->forest.mesh().n_global_active_cells();
}

Vec3 ParticleStore::Implementation::reference(const std::int32_t row) const
{
  return is_new(row) ? domain.periods().wrap(new_one(row).position) : written->reference[row];
}

void ParticleStore::write(const ParticleArrays &particles, const std::vector<double> &work)
{
  Implementation &impl = *implementation;
  impl.written = &particles;
  for (auto &particle : impl.handler) {
    const auto properties = particle.get_properties();
    std::int32_t row = decode(properties[property::origin]).row;
    if (!impl.rows_now.empty()) {
      row = impl.rows_now[row];
      properties[property::origin] =
          row == Remaining::none ? encode({}) : encode({static_cast<int>(impl.rank), row});
      if (row == Remaining::none)
        continue;
    }
    properties[property::work] = work[row];
    properties[property::asleep] = impl.asleep ? particles.extra[impl.asleep->first][row] : 0.;
  }
}

void ParticleStore::leave_out(const Remaining &remaining, const std::uint64_t n)
{
  Implementation &impl = *implementation;
  if (impl.rows_now.empty()) {
    impl.rows_now.resize(impl.handler.n_locally_owned_particles());
    std::iota(impl.rows_now.begin(), impl.rows_now.end(), 0);
  }
  for (std::int32_t &row : impl.rows_now)
    if (row != Remaining::none)
      row = remaining[row];
  impl.n_left_out += n;
}

void ParticleStore::remove(const std::vector<std::size_t> &rows)
{
  Implementation &impl = *implementation;
  std::vector<bool> leaves(impl.n_written(), false);
  for (const std::size_t row : rows)
    leaves[row] = true;
  std::vector<Implementation::Handler::particle_iterator> leaving;
  if (!rows.empty() || !impl.rows_now.empty())
    for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle) {
      const Origin origin = decode(particle->get_properties()[property::origin]);
      if (origin.rank < 0 || leaves[origin.row])
        leaving.push_back(particle);
    }
  impl.handler.remove_particles(leaving);
  impl.rows_now.clear();
  impl.n_left_out = 0;
}

namespace {

constexpr std::array<std::vector<Quad> ParticleArrays::*, 5> quads = {
    {&ParticleArrays::position, &ParticleArrays::velocity, &ParticleArrays::spin,
     &ParticleArrays::force, &ParticleArrays::torque}};

Quad with(const Vec3 &v, const double w)
{
  return {v.x, v.y, v.z, w};
}

/// Replaces a vector by one of other entries, and keeps the old one's memory for the next.
template <typename Entry, typename Value>
void replace(std::vector<Entry> &vector, std::vector<Entry> &spare, const std::size_t n,
             const Value &value)
{
  spare.resize(n);
  for (std::size_t row = 0; row < n; ++row)
    spare[row] = value(row);
  vector.swap(spare);
}

} // namespace

/// The states of the particles that this rank has now, wherever they were kept, in the order of the
/// handler.
class ParticleStore::States
{
public:
  /// Fetches those of other ranks; collective.
  explicit States(const Implementation &impl) : impl(impl)
  {
    const auto here = static_cast<int>(impl.rank);
    std::vector<Origin> wanted;
    sources.reserve(impl.handler.n_locally_owned_particles());
    for (const auto &particle : impl.handler) {
      const Origin origin = decode(particle.get_properties()[property::origin]);
      sources.push_back(origin.rank == here ? origin.row
                                            : -1 - static_cast<std::int32_t>(wanted.size()));
      if (origin.rank != here)
        wanted.push_back(origin);
    }
    fetched = fetch_foreign(
        wanted, n_fixed + impl.n_extra,
        [this](const std::int32_t row, std::vector<double> &values) { pack(row, values); },
        impl.domain.communicator());
  }

  std::size_t size() const { return sources.size(); }

  Quad quad(const unsigned int c, const std::size_t k) const
  {
    if (sources[k] >= 0)
      return kept(c, sources[k]);
    const double *const q = foreign(k) + 4 * static_cast<std::size_t>(c);
    return {q[0], q[1], q[2], q[3]};
  }

  Vec3 reference(const std::size_t k) const
  {
    if (sources[k] >= 0)
      return impl.reference(sources[k]);
    const double *const v = foreign(k) + 4 * quads.size();
    return {v[0], v[1], v[2]};
  }

  std::int32_t type(const std::size_t k) const
  {
    return sources[k] >= 0 ? kept_type(sources[k])
                           : static_cast<std::int32_t>(foreign(k)[n_fixed - 2]);
  }

  /// Where a particle's contacts are kept.
  Origin contacts(const std::size_t k) const
  {
    return sources[k] >= 0 ? kept_contacts(sources[k]) : decode(foreign(k)[n_fixed - 1]);
  }

  double extra(const unsigned int e, const std::size_t k) const
  {
    return sources[k] >= 0 ? kept_extra(e, sources[k]) : foreign(k)[n_fixed + e];
  }

private:
  static constexpr std::size_t n_fixed = 4 * quads.size() + 3 + 2;

  void pack(const std::int32_t row, std::vector<double> &values) const
  {
    for (unsigned int c = 0; c < quads.size(); ++c) {
      const Quad q = kept(c, row);
      values.insert(values.end(), {q.x, q.y, q.z, q.w});
    }
    const Vec3 reference = impl.reference(row);
    values.insert(values.end(), {reference.x, reference.y, reference.z});
    values.push_back(kept_type(row));
    values.push_back(encode(kept_contacts(row)));
    for (unsigned int e = 0; e < impl.n_extra; ++e)
      values.push_back(kept_extra(e, row));
  }

  const double *foreign(const std::size_t k) const
  {
    return &fetched[(n_fixed + impl.n_extra) * static_cast<std::size_t>(-1 - sources[k])];
  }

  Quad kept(const unsigned int c, const std::int32_t row) const
  {
    if (!impl.is_new(row)) {
      const Quad &q = ((*impl.written).*quads[c])[row];
      return with(q.vec(), c <= 2 ? q.w : 0.);
    }
    const NewParticle &p = impl.new_one(row);
    return c == 0   ? with(impl.reference(row), p.radius)
           : c == 1 ? with(p.velocity, p.mass)
           : c == 2 ? with(p.spin, 0.4 * p.mass * p.radius * p.radius)
                    : Quad();
  }

  std::int32_t kept_type(const std::int32_t row) const
  {
    return impl.is_new(row) ? impl.new_one(row).type : impl.written->type[row];
  }

  Origin kept_contacts(const std::int32_t row) const
  {
    if (!impl.is_new(row))
      return {static_cast<std::int32_t>(impl.rank), row};
    return impl.incoming_contacts.empty() ? Origin()
                                          : impl.incoming_contacts[row - impl.n_written()];
  }

  double kept_extra(const unsigned int e, const std::int32_t row) const
  {
    return impl.is_new(row) ? impl.incoming_extra[e] : impl.written->extra[e][row];
  }

  const Implementation &impl;
  std::vector<std::int32_t> sources; ///< rows of this rank; -1 - k for the k-th that was fetched
  std::vector<double> fetched;
};

std::vector<std::uint32_t> ParticleStore::Implementation::order(const States &states,
                                                                const ContactGrid &grid)
{
  struct Entry
  {
    std::uint64_t key;
    ParticleId id;
    std::uint32_t number, cell;
  };
  std::vector<Entry> entries;
  entries.reserve(states.size());
  for (const auto &particle : handler) {
    const auto number = static_cast<std::uint32_t>(entries.size());
    entries.push_back({grid.key(states.reference(number)),
                       static_cast<ParticleId>(particle.get_id()), number,
                       particle.get_surrounding_cell()->active_cell_index()});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
    return a.key != b.key ? a.key < b.key : a.id < b.id;
  });
  std::vector<std::uint32_t> numbers;
  cells.clear();
  for (const Entry &entry : entries) {
    numbers.push_back(entry.number);
    cells.push_back(entry.cell);
  }
  return numbers;
}

void ParticleStore::read(ParticleArrays &arrays, const ContactGrid &grid,
                         std::vector<Origin> &contacts)
{
  Implementation &impl = *implementation;
  const States states(impl);
  const std::vector<std::uint32_t> order = impl.order(states, grid);
  const std::size_t n = order.size();

  // One vector after the other, as those that are filled may be those that are read.
  contacts.resize(n);
  for (std::size_t row = 0; row < n; ++row)
    contacts[row] = states.contacts(order[row]);
  {
    std::vector<Quad> spare;
    for (unsigned int c = 0; c < quads.size(); ++c)
      replace(arrays.*quads[c], spare, n,
              [&](const std::size_t row) { return states.quad(c, order[row]); });
  }
  {
    std::vector<Vec3> spare;
    replace(arrays.reference, spare, n,
            [&](const std::size_t row) { return states.reference(order[row]); });
  }
  {
    std::vector<std::int32_t> spare;
    replace(arrays.type, spare, n, [&](const std::size_t row) { return states.type(order[row]); });
  }
  std::vector<double> spare;
  std::vector<std::vector<double>> &extra = arrays.extra;
  extra.resize(impl.n_extra);
  for (unsigned int e = 0; e < impl.n_extra; ++e)
    replace(extra[e], spare, n, [&](const std::size_t row) { return states.extra(e, order[row]); });

  arrays.resize(n, 0, impl.n_extra);
  std::vector<std::uint32_t> row_of(n);
  for (std::size_t row = 0; row < n; ++row) {
    row_of[order[row]] = static_cast<std::uint32_t>(row);
  }
  std::size_t number = 0;
  for (auto &particle : impl.handler) {
    const auto row = static_cast<std::int32_t>(row_of[number++]);
    arrays.id[row] = static_cast<ParticleId>(particle.get_id());
    particle.get_properties()[property::origin] = encode({static_cast<int>(impl.rank), row});
  }
  impl.written = nullptr;
  // Braces alone would keep the memory.
  impl.incoming = std::vector<NewParticle>();
  impl.incoming_contacts = std::vector<Origin>();
}

void ParticleStore::ranks_near(const std::size_t row, const Vec3 &reference, const double reach,
                               std::vector<int> &ranks) const
{
  if (reach > implementation->reach)
    throw std::logic_error("ghosts are wanted from farther away than the mesh looks");
  const PeriodicBox &box = implementation->domain.periods();
  // Particles that stick out of the domain are in its outermost cells.
  const Vec3 x = implementation->forest.clamp(implementation->domain.to_own_frame(reference));
  ranks.clear();
  for (const Forest::ForeignCell &cell : implementation->near_cell[implementation->cells[row]]) {
    if (!ranks.empty() && ranks.back() == cell.rank)
      continue;
    const Vec3 away = box.shortest(x - cell.centre);
    double distance2 = 0.;
    for (unsigned int d = 0; d < 3; ++d) {
      const double outside = std::max(0., std::abs(away[d]) - cell.half[d]);
      distance2 += outside * outside;
    }
    if (distance2 <= reach * reach)
      ranks.push_back(cell.rank);
  }
}

} // namespace eunoe
