// Measurements of a spreading run: the same bits on one rank and on all, and after a restart, with
// and without side walls; and every observable has a description.

#include "small_case.h"
#include "tests.h"

#include <filesystem>

using namespace test;

namespace {

bool are_same(const std::vector<Measurement> &a, const std::vector<Measurement> &b)
{
  return !a.empty() && std::equal(a.begin(), a.end(), b.begin(), b.end(),
                                  [](const Measurement &x, const Measurement &y) {
                                    return x.observable == y.observable && x.index == y.index &&
                                           x.value == y.value;
                                  });
}

std::size_t count(const std::vector<Measurement> &all, const std::string &observable)
{
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [&](const Measurement &m) { return m.observable == observable; }));
}

/// @param more entries of subsection powder spreading
/// @param others further subsections
void examine(const std::string &name, const std::string &more, const std::string &others = "")
{
  int rank, n_ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  const std::string checkpoints =
      others + "subsection restart\n set checkpoint = true\n set frequency = 15000\n";
  const std::string folder = "results_" + name;
  Case all(small_spreading(folder, more, checkpoints + "end\n"));
  unsigned long long most_asleep = 0;
  all.run([&most_asleep](Simulation &simulation) {
    const ParticleArrays &p = simulation.get_system().particles;
    most_asleep = std::max<unsigned long long>(most_asleep, p.n_owned - p.n_awake());
  });
  const auto measured = all->measurements();
  if (n_ranks > 1) {
    Case alone(small_spreading(folder + std::to_string(rank), more, others), MPI_COMM_SELF);
    alone.run();
    check(name + ": on one rank", are_same(measured, alone->measurements()));
    check(name + ": the same grains", particle_table(*all) == particle_table(*alone));
  }
  if (!others.empty()) {
    MPI_Allreduce(MPI_IN_PLACE, &most_asleep, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
    check(name + ": some sleep", most_asleep > 50, std::to_string(most_asleep));
  }
  // Continues from the last checkpoint before the one of the end.
  if (rank == 0) {
    std::filesystem::path last;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".checkpoint" && entry.path() > last)
        last = entry.path();
    std::filesystem::remove(last);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  Case again(small_spreading(folder, more, checkpoints + " set restart = true\nend\n"));
  std::size_t n_before = 0;
  again.run([&n_before](Simulation &simulation) {
    if (n_before == 0)
      n_before = simulation.measurements().size();
  });
  check(name + ": a layer was weighed before the restart",
        n_before > 0 && n_before < measured.size());
  check(name + ": after a restart", are_same(measured, again->measurements()));

  if (n_ranks > 1)
    return;
  const auto described = all->described_observables();
  check(name + ": every measurement is described",
        std::all_of(measured.begin(), measured.end(), [&](const Measurement &m) {
          return std::any_of(
              described.begin(), described.end(),
              [&](const ObservableDescription &d) { return d.name == m.observable; });
        }));
  check(name + ": layers and bins",
        count(measured, "mass") == 2 && count(measured, "LRD") == 1 &&
            count(measured, "CRD") == 0 && count(measured, "mass_removed") == 1 &&
            count(measured, "surface_height") == 4 && count(measured, "surface_roughness") == 1 &&
            count(measured, "solid_fraction") == 3);
  const auto lies_between = [&](const std::string &observable, double low, double high) {
    for (const Measurement &m : measured)
      if (m.observable == observable && !(m.value > low && m.value < high))
        return format(m.value);
    return std::string();
  };
  // Where no grain lies in a bin the surface is the bare plate, a tenth lower than it should be.
  const std::string height = lies_between("surface_height", -1.11 * layer_thickness, clearance);
  check(name + ": surface between plate and spreader", height.empty(), height);
  const std::string density = lies_between("solid_fraction", -1e-12, 0.7);
  check(name + ": solid fractions of layers", density.empty(), density);
  const std::string mean = lies_between("mean_diameter", 59.99e-6, 80.01e-6);
  check(name + ": mean diameter between the smallest and the largest", mean.empty(), mean);
}

} // namespace

EUNOE_MPI_TEST()
{
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks == 1)
    examine("periodic", ""); // what it has, the others have, too
  examine("faults", R"(
  set spreader tilt                = 30e-6
  set spreader vibration amplitude = 5e-6
  set spreader vibration frequency = 400
  set layer thickness error        = 0.1
  set plate recoil                 = 20e-6
  set side walls                   = true
  set side wall friction           = 0.2)");
  examine("full", "  set feedstock = full\n  set spreader = flat blade");
  examine("asleep", "", R"(
subsection model parameters
  subsection adaptive sparse contacts
    set enable adaptive sparse contacts = true
  end
  subsection load balancing
    set load balance method = frequent
    set frequency           = 300
  end
end
)");
}
