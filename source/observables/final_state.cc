#include <eunoe/simulation/simulation.h>

#include <algorithm>

namespace eunoe {
namespace {

/// The particles at the end of the run, ordered by id, in the format of the 'file' insertion.
class FinalState : public Observable
{
public:
  FinalState(const RecordSection &section, Simulation &) : name(section.file) {}

  void finish(Simulation &simulation) override
  {
    constexpr std::size_t n_values = 11;
    const ParticleArrays &p = simulation.complete_step();
    std::vector<double> mine;
    mine.reserve(n_values * p.n_owned);
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      mine.push_back(p.id[k]);
      for (const Quad *q : {&p.position[k], &p.velocity[k], &p.spin[k]})
        mine.insert(mine.end(), {q->x, q->y, q->z});
      mine.push_back(2. * p.radius(k));
    }
    std::vector<double> all = gather_on_first(mine, simulation.communicator());

    std::vector<const double *> rows;
    for (std::size_t k = 0; k < all.size(); k += n_values)
      rows.push_back(&all[k]);
    std::sort(rows.begin(), rows.end(),
              [](const double *a, const double *b) { return a[0] < b[0]; });
    std::string text = "p_x; p_y; p_z; v_x; v_y; v_z; w_x; w_y; w_z; diameters;\n";
    for (const double *row : rows) {
      char cell[32];
      for (std::size_t c = 1; c < n_values; ++c) {
        std::snprintf(cell, sizeof cell, "%.17g;%c", row[c], c + 1 < n_values ? ' ' : '\n');
        text += cell;
      }
    }
    simulation.output_folder().write(name + ".csv", text);
  }

private:
  static std::vector<double> gather_on_first(const std::vector<double> &mine, MPI_Comm comm)
  {
    int n_ranks;
    MPI_Comm_size(comm, &n_ranks);
    const int n = static_cast<int>(mine.size());
    std::vector<int> counts(n_ranks), starts(n_ranks, 0);
    MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
    for (int r = 1; r < n_ranks; ++r)
      starts[r] = starts[r - 1] + counts[r - 1];
    std::vector<double> all(starts.back() + counts.back());
    MPI_Gatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, 0,
                comm);
    return all;
  }

  const std::string name;
};

const ObservableRegistry::Registration registration(observables(), "final state", [] {
  return std::make_unique<SectionOf<FinalState>>(
      ParameterCheck::Path{"post-processing", "final state"},
      RecordSection::Texts{
          "Whether the particles are written at the end, in the format that the 'file' "
          "insertion reads."},
      "particles", 0);
});

} // namespace
} // namespace eunoe
