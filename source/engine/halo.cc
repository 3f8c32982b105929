#include <eunoe/core/message_tags.h>
#include <eunoe/core/sparse_exchange.h>
#include <eunoe/engine/halo.h>

#include <algorithm>
#include <map>

namespace eunoe {

namespace {

/// Doubles per ghost when it is made (all that is constant, then the state) and at every step.
constexpr std::size_t build_size = 17, update_size = 9;

void append(std::vector<double> &values, const Vec3 &v)
{
  values.insert(values.end(), {v.x, v.y, v.z});
}

void append(std::vector<double> &values, const Quad &q, bool with_w)
{
  values.insert(values.end(), {q.x, q.y, q.z});
  if (with_w)
    values.push_back(q.w);
}

} // namespace

void Halo::exchange(const int tag)
{
  std::vector<MPI_Request> requests(2 * neighbours.size());
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    Neighbour &neighbour = neighbours[n];
    MPI_Irecv(neighbour.in.data(), static_cast<int>(neighbour.in.size()), MPI_DOUBLE,
              neighbour.rank, tag, comm, &requests[2 * n]);
    MPI_Isend(neighbour.out.data(), static_cast<int>(neighbour.out.size()), MPI_DOUBLE,
              neighbour.rank, tag, comm, &requests[2 * n + 1]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

std::map<int, std::vector<std::int32_t>> Halo::rows_near(const ParticleArrays &particles,
                                                         const ParticleStore &store,
                                                         const double separation) const
{
  std::map<int, std::vector<std::int32_t>> rows;
  double largest_radius = 0.;
  for (std::size_t row = 0; row < particles.n_owned; ++row)
    largest_radius = std::max(largest_radius, particles.radius(row));
  MPI_Allreduce(MPI_IN_PLACE, &largest_radius, 1, MPI_DOUBLE, MPI_MAX, comm);
  std::vector<int> ranks;
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    const double reach = 1.0001 * (particles.radius(row) + largest_radius + separation);
    store.ranks_near(row, particles.reference[row], reach, ranks);
    for (const int rank : ranks)
      rows[rank].push_back(static_cast<std::int32_t>(row));
  }
  return rows;
}

void Halo::send_new(const ParticleArrays &particles,
                    const std::map<int, std::vector<std::int32_t>> &rows)
{
  std::map<int, int> n_sent;
  for (const auto &[rank, list] : rows)
    n_sent[rank] = static_cast<int>(list.size());
  const std::map<int, int> n_received = numbers_from(n_sent, comm);
  std::map<int, Neighbour> by_rank;
  for (const auto &[rank, list] : rows)
    by_rank[rank].sent = list;
  for (const auto &[rank, n] : n_received)
    by_rank[rank].received.resize(n);
  for (auto &[rank, neighbour] : by_rank) {
    neighbour.rank = rank;
    for (const std::int32_t row : neighbour.sent) {
      append(neighbour.out, particles.position[row], true);
      append(neighbour.out, particles.velocity[row], true);
      append(neighbour.out, particles.spin[row], true);
      neighbour.out.push_back(particles.id[row]);
      neighbour.out.push_back(particles.type[row]);
      append(neighbour.out, particles.reference[row]);
    }
    neighbour.in.resize(build_size * neighbour.received.size());
    neighbours.push_back(std::move(neighbour));
  }
  exchange(tag_halo_build);
}

void Halo::append_received(ParticleArrays &particles, const ContactGrid &grid)
{
  struct Ghost
  {
    std::uint64_t key;
    ParticleId id;
    const double *values;
    std::int32_t *row;
  };
  std::vector<Ghost> ghosts;
  for (Neighbour &neighbour : neighbours)
    for (std::size_t k = 0; k < neighbour.received.size(); ++k) {
      const double *const v = &neighbour.in[build_size * k];
      ghosts.push_back({grid.key({v[14], v[15], v[16]}), static_cast<ParticleId>(v[12]), v,
                        &neighbour.received[k]});
    }
  std::sort(ghosts.begin(), ghosts.end(), [](const Ghost &a, const Ghost &b) {
    return a.key != b.key ? a.key < b.key : a.id < b.id;
  });
  particles.resize(particles.n_owned, ghosts.size(),
                   static_cast<unsigned int>(particles.extra.size()));
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const std::size_t row = particles.n_owned + g;
    const double *const v = ghosts[g].values;
    particles.position[row] = {v[0], v[1], v[2], v[3]};
    particles.velocity[row] = {v[4], v[5], v[6], v[7]};
    particles.spin[row] = {v[8], v[9], v[10], v[11]};
    particles.force[row] = particles.torque[row] = Quad();
    particles.id[row] = ghosts[g].id;
    particles.type[row] = static_cast<std::int32_t>(v[13]);
    particles.reference[row] = {v[14], v[15], v[16]};
    *ghosts[g].row = static_cast<std::int32_t>(row);
  }
}

void Halo::build(ParticleArrays &particles, const ParticleStore &store, const ContactGrid &grid,
                 const double separation)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  neighbours.clear();
  everyone.clear();
  if (n_ranks == 1)
    return;
  send_new(particles, rows_near(particles, store, separation));
  append_received(particles, grid);
  for (Neighbour &neighbour : neighbours)
    neighbour.out = neighbour.in = {};
  everyone = neighbours;
  include_sleepers();
}

void Halo::update_all(ParticleArrays &particles, std::vector<ContactGrid::Moved> &moved)
{
  neighbours = everyone;
  include_sleepers();
  update(particles);
  update_references(particles, moved);
}

void Halo::update_references(ParticleArrays &particles, std::vector<ContactGrid::Moved> &moved)
{
  for (Neighbour &neighbour : neighbours) {
    neighbour.out.clear();
    for (const std::int32_t row : neighbour.sent)
      append(neighbour.out, particles.reference[row]);
    neighbour.in.resize(3 * neighbour.received.size());
  }
  exchange(tag_halo_references);
  for (const Neighbour &neighbour : neighbours)
    for (std::size_t k = 0; k < neighbour.received.size(); ++k) {
      const double *const in = &neighbour.in[3 * k];
      Vec3 &reference = particles.reference[neighbour.received[k]];
      const Vec3 now{in[0], in[1], in[2]};
      if (norm_square(now - reference) > 0.)
        moved.push_back({neighbour.received[k], reference});
      reference = now;
    }
}

void Halo::leave_out(const Remaining &remaining)
{
  for (auto *list : {&neighbours, &everyone})
    for (Neighbour &neighbour : *list) {
      remaining.renumber(neighbour.sent);
      remaining.renumber(neighbour.received);
    }
  include_sleepers();
}

void Halo::leave_out_unpaired(const ParticleArrays &particles, const PairList &pairs)
{
  if (neighbours.empty())
    return;
  std::vector<std::uint8_t> is_paired(particles.size(), 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    is_paired[pairs.i[k]] = is_paired[pairs.j[k]] = 1;
  // Receivers of ghosts tell the senders which of them are in pairs.
  for (Neighbour &neighbour : neighbours) {
    neighbour.out.clear();
    for (const std::int32_t row : neighbour.received)
      neighbour.out.push_back(is_paired[row]);
    neighbour.in.resize(neighbour.sent.size());
  }
  exchange(tag_halo_paired);
  const auto keep = [](std::vector<std::int32_t> &rows, const std::vector<double> &wanted) {
    std::size_t n = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (wanted[k] != 0.)
        rows[n++] = rows[k];
    rows.resize(n);
  };
  for (Neighbour &neighbour : neighbours) {
    keep(neighbour.received, neighbour.out);
    keep(neighbour.sent, neighbour.in);
  }
  neighbours.erase(std::remove_if(neighbours.begin(), neighbours.end(),
                                  [](const Neighbour &neighbour) {
                                    return neighbour.sent.empty() && neighbour.received.empty();
                                  }),
                   neighbours.end());
  include_sleepers();
}

std::size_t Halo::n_ghosts() const
{
  std::size_t n = 0;
  for (const Neighbour &neighbour : neighbours)
    n += neighbour.received.size();
  return n;
}

void Halo::include_sleepers()
{
  for (Neighbour &neighbour : neighbours) {
    neighbour.sent_awake = neighbour.sent;
    neighbour.received_awake = neighbour.received;
  }
}

void Halo::leave_out_sleepers(const ParticleArrays &particles)
{
  const auto awake = [&](const std::vector<std::int32_t> &rows) {
    std::vector<std::int32_t> list;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(list),
                 [&](const std::int32_t row) { return particles.is_awake(row); });
    return list;
  };
  for (Neighbour &neighbour : neighbours) {
    neighbour.sent_awake = awake(neighbour.sent);
    neighbour.received_awake = awake(neighbour.received);
  }
}

void Halo::update(std::vector<std::uint8_t> &flags)
{
  for (Neighbour &neighbour : neighbours) {
    neighbour.out.clear();
    for (const std::int32_t row : neighbour.sent)
      neighbour.out.push_back(flags[row]);
    neighbour.in.resize(neighbour.received.size());
  }
  exchange(tag_halo_flags);
  for (const Neighbour &neighbour : neighbours)
    for (std::size_t k = 0; k < neighbour.received.size(); ++k)
      flags[neighbour.received[k]] = static_cast<std::uint8_t>(neighbour.in[k]);
}

void Halo::update(ParticleArrays &particles)
{
  if (neighbours.empty())
    return;
  for (Neighbour &neighbour : neighbours) {
    neighbour.out.resize(update_size * neighbour.sent_awake.size());
    neighbour.in.resize(update_size * neighbour.received_awake.size());
    double *out = neighbour.out.data();
    for (const std::int32_t row : neighbour.sent_awake)
      for (const Quad *q :
           {&particles.position[row], &particles.velocity[row], &particles.spin[row]}) {
        *out++ = q->x;
        *out++ = q->y;
        *out++ = q->z;
      }
  }
  exchange(tag_halo_update);
  for (const Neighbour &neighbour : neighbours) {
    const double *in = neighbour.in.data();
    for (const std::int32_t row : neighbour.received_awake)
      for (Quad *q : {&particles.position[row], &particles.velocity[row], &particles.spin[row]}) {
        q->x = *in++;
        q->y = *in++;
        q->z = *in++;
      }
  }
}

} // namespace eunoe
