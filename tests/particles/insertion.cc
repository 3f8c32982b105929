// Methods of insertion: the grid of a box keeps particles apart and inside the box and does not
// depend on the number of ranks, lists and files give the stated particles, and a written state can
// be read back.

#include <eunoe/core/files.h>

#include "../on_one_rank.h"

using namespace test;

namespace {

std::string case_with(const std::string &insertion)
{
  return box_input(1e-6, 1e-6,
                   "subsection lagrangian physical properties\n subsection particle type 0\n"
                   "  set size distribution type = normal\n  set average diameter = 1e-3\n"
                   "  set standard deviation = 1e-4\n  set number of particles = 400\n end\nend\n"
                   "subsection insertion info\n" +
                       insertion + "\nend\n");
}

void test_volume()
{
  // Random numbers belong to particles, not to ranks.
  const Numbers all = same_on_one_rank("grid", [](MPI_Comm comm) {
    Case grid(
        case_with(" set insertion box points coordinates = -5e-3, -5e-3, -5e-3 : 5e-3, 9e-3, 9e-3\n"
                  " set insertion distance threshold = 1.2\n"
                  " set insertion maximum offset = 0.2"),
        comm);
    grid.run();
    return particle_table(*grid);
  });
  check("number", all.size() == 400 && all.front()[c_id] == 1.);
  double smallest_gap = 1., sum = 0.;
  bool inside = true;
  for (const auto &a : all) {
    const double r = a[c_radius];
    inside = inside && a[c_x] - r >= -5e-3 && a[c_x] + r <= 5e-3 && a[c_z] + r <= 9e-3;
    sum += a[c_x] + 2. * a[c_y] + 3. * a[c_z] + 4. * r;
    for (const auto &b : all)
      if (a[c_id] < b[c_id])
        smallest_gap =
            std::min(smallest_gap, norm(Vec3{a[c_x] - b[c_x], a[c_y] - b[c_y], a[c_z] - b[c_z]}) -
                                       r - b[c_radius]);
  }
  check("inside the box", inside);
  check("apart from each other", smallest_gap >= 0.);
  // Recorded, so that a change of the random numbers is noticed.
  char text[64];
  std::snprintf(text, sizeof text, "fingerprint %.9f", sum);
  print(text);
}

void test_list_and_file()
{
  Case list(case_with(" set insertion method = list\n set list x = 1e-3, -2e-3\n"
                      " set list y = 0, 1e-3\n set list z = 5e-3, 0\n"
                      " set list velocity y = 0.5, -1\n set list omega z = 3, 4\n"
                      " set list diameters = 1e-3, 5e-4") +
            "subsection post-processing\n subsection final state\n  set calculation = true\n"
            "  set filename = state\n end\nend\n");
  list.run();
  const auto written = particle_table(*list);
  check("list: position", written[1][c_x] == -2e-3 && written[0][c_z] == 5e-3);
  check("list: diameter and spin", written[1][c_radius] == 2.5e-4 && written[1][c_wz] == 4.);

  Case file(
      case_with(" set insertion method = file\n set list of input files = results/state.csv"));
  file.run([&](Simulation &simulation) {
    if (simulation.step_number() == 0)
      check("file: the state that was written", particle_table(simulation) == written);
  });
}

/// Fewer particles than ranks: some ranks have nothing to insert.
void test_single_particle()
{
  Case single(case_with(" set insertion method = list\n set list x = 1e-3\n set list y = 0\n"
                        " set list z = -2e-3\n set list velocity y = 0.5\n"
                        " set list diameters = 1e-3"));
  single.run();
  const auto all = particle_table(*single);
  check("a single particle", all.size() == 1 && all[0][c_id] == 1. && all[0][c_z] == -2e-3);
}

/// A file may hold larger particles than the types' sizes; contacts between them must be found.
void test_large_particles_of_a_file()
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    write_file("large.csv", "p_x; p_y; p_z; diameters\n0; 0; 0; 3e-3\n0; 0; 2.9e-3; 3e-3\n");
  MPI_Barrier(MPI_COMM_WORLD);
  Case file(case_with(" set insertion method = file\n set list of input files = large.csv"));
  file.run();
  const auto all = particle_table(*file);
  check("large particles of a file repel each other",
        all.size() == 2 && all[0][c_vz] < 0. && all[1][c_vz] > 0.);
  check("their number is known before",
        file->estimate().most_particles == 2. && file->estimate().steps == 1.);
}

/// Files come in turn until there are as many particles as their type has.
void test_number_of_files()
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    write_file("two.csv", "p_x; p_y; p_z; diameters\n0; 0; 0; 1e-3\n0; 0; 2e-3; 1e-3\n");
    write_file("one.csv", "p_x; p_y; p_z; diameters\n0; 4e-3; 0; 1e-3\n");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string files =
      " set insertion method = file\n set list of input files = one.csv, two.csv\n"
      " set insertion frequency = 10\n set remove particles = true\n"
      " set removal box points coordinates = -1, -1, -1 : 1, 1, 1";
  for (const int most : {5, 0}) {
    Case file(case_with(files) +
              "subsection lagrangian physical properties\n subsection particle "
              "type 0\n  set number of particles = " +
              std::to_string(most) +
              "\n end\nend\nsubsection simulation control\n set time end = 5e-5\nend\n");
    file.run();
    const std::uint64_t n = file->get_ledger().inserted.global(file->communicator()).number;
    check("files until there are " + std::to_string(most), n == (most == 5 ? 5u : 9u),
          std::to_string(n));
  }
}

/// A list comes again at every event, until there are as many of each type as it has.
void test_repeated_list()
{
  const std::string two =
      " set insertion method = list\n set list x = 1e-3, -2e-3\n"
      " set list y = 0, 1e-3\n set list z = 5e-3, 0\n set list diameters = 1e-3\n"
      " set list velocity y = 0.5\n set remove particles = true\n"
      " set removal box points coordinates = -1, -1, -1 : 1, 1, 1\n";
  const auto types = [](const int first, const int second) {
    return "subsection lagrangian physical properties\n set number of particle types = 2\n"
           " subsection particle type 0\n  set number of particles = " +
           std::to_string(first) +
           "\n end\n subsection particle type 1\n  set number of particles = " +
           std::to_string(second) +
           "\n  set diameter = 1e-3\n  set density particles = 3000\n"
           " end\nend\nsubsection simulation control\n set time end = 1e-4\nend\n";
  };
  const std::string often = " set insertion frequency = 10\n";
  for (const auto &[settings, first, second, wanted] :
       {std::tuple(often, 3, 3, 6u), std::tuple(often, 0, 1, 3u),
        std::tuple(std::string(), 3, 3, 2u), std::tuple(often, 1, 0, 1u)})
  {
    Case list(case_with(two + settings) + types(first, second));
    list.run([](Simulation &simulation) {
      const auto now = particle_table(simulation);
      if (simulation.step_number() == 0 && now.size() == 2)
        check("the velocity of the first alone", now[0][c_vy] > 0.4 && now[1][c_vy] == 0.);
    });
    const Tally all = list->get_ledger().inserted.global(list->communicator());
    const std::string name = "a list of two for " + std::to_string(first) + " and " +
                             std::to_string(second) + (settings.empty() ? ", once" : "");
    check(name, all.number == wanted, std::to_string(all.number));
    const unsigned int n_first = std::min<unsigned int>(first == 0 ? 2 : first, wanted);
    check_close(name + ": types", all.mass.value(),
                sphere_mass(0.5e-3, 1000.) * (n_first + 3. * (wanted - n_first)), 1e-12);
    check("their number is known before", list->estimate().most_particles == wanted);
  }
}

/// All types in a single event, and over several.
void test_types()
{
  for (const unsigned int frequency : {0u, 1u}) {
    const std::string events = frequency == 0
                                   ? ""
                                   : " set insertion frequency = 1\n"
                                     " set inserted number of particles at each time step = 25\n";
    Case mixed(box_input(1e-6, 2e-6,
                         "subsection lagrangian physical properties\n"
                         " set number of particle types = 3\n"
                         " subsection particle type 0\n  set number of particles = 20\n end\n"
                         " subsection particle type 2\n  set number of particles = 30\n"
                         "  set diameter = 5e-4\n end\nend\n"
                         "subsection insertion info\n"
                         " set insertion box points coordinates = -5e-3, -5e-3, -5e-3 : 5e-3, "
                         "5e-3, 5e-3\n set insertion distance threshold = 1.2\n"
                         " set insertion maximum offset = 0.2\n" +
                             events + "end\n"));
    mixed.run();
    const auto all = particle_table(*mixed);
    const auto small =
        std::count_if(all.begin(), all.end(), [](const auto &p) { return p[c_radius] == 2.5e-4; });
    check(frequency == 0 ? "types in one event" : "types in two events",
          all.size() == 50 && small == 30);
  }
}

/// Points of the grid where a function is not positive stay empty; all particles find room in the
/// others.
void test_acceptance()
{
  Case cylinder(
      case_with(" set insertion box points coordinates = -9e-3, -9e-3, -9e-3 : 9e-3, 9e-3, "
                "9e-3\n set insertion distance threshold = 1.2\n"
                " subsection insertion acceptance function\n"
                "  set Function constants = R=7e-3\n"
                "  set Function expression = R^2 - x^2 - z^2\n end"));
  cylinder.run();
  const auto all = particle_table(*cylinder);
  const bool inside = std::all_of(all.begin(), all.end(),
                                  [](const auto &p) { return std::hypot(p[c_x], p[c_z]) <= 7e-3; });
  const bool fills = std::any_of(all.begin(), all.end(),
                                 [](const auto &p) { return std::hypot(p[c_x], p[c_z]) > 6e-3; });
  check("acceptance function", all.size() == 400 && inside && fills);
}

/// The removal box is emptied before every event, also before the first.
void test_removal()
{
  const std::string removal =
      " set insertion box points coordinates = -5e-3, -5e-3, -5e-3 : 5e-3, -3e-3, 5e-3\n"
      " set insertion frequency = 2\n set inserted number of particles at each time step = 10\n"
      " set initial velocity = 0, 0.5, 0\n set insertion distance threshold = 1.2\n"
      " set remove particles = true\n"
      " set removal box points coordinates = -1e-2, -3.5e-3, -1e-2 : 1e-2, 1e-2, 1e-2";
  std::vector<double> numbers;
  Case removing(box_input(1e-3, 8e-3,
                          "subsection lagrangian physical properties\n subsection particle type 0\n"
                          "  set average diameter = 1e-3\n  set number of particles = 40\n end\n"
                          "end\nsubsection insertion info\n" +
                              removal + "\nend\n"));
  removing.run([&](Simulation &simulation) {
    numbers.push_back(static_cast<double>(particle_table(simulation).size()));
  });
  // Particles rise by 0.5 mm a step from below -4 mm, so that all those of an event are there for
  // four steps at most.
  const double removed = removing->get_ledger().taken_out.global(MPI_COMM_WORLD).number;
  check("removal box", numbers.front() == 10. && removed >= 10. &&
                           particle_table(*removing).size() + removed == 40.);
  for (const auto &p : particle_table(*removing))
    if (p[c_id] <= 10.)
      print("particle " + std::to_string(static_cast<int>(p[c_id])) + " was not removed");
}

void test_errors()
{
  const auto refused = [](const std::string &insertion) -> std::string {
    try {
      Case test_case(case_with(insertion));
      test_case.run();
    } catch (const UserError &error) {
      return error.what();
    }
    return "";
  };
  check("a box outside the mesh is refused",
        refused(" set insertion box points coordinates = 4, 0, 0 : 5, 5, 5")
                .find("the box lies outside the mesh") != std::string::npos);
  check("a particle outside the mesh is refused",
        refused(" set insertion method = list\n set list x = 1\n set list y = 0\n set list z = 0")
                .find("inserted outside the mesh") != std::string::npos);
  check("too little room is refused",
        refused(" set insertion box points coordinates = 0, 0, 0 : 5e-3, 5e-3, 5e-3\n"
                " set insertion distance threshold = 1.2\n set insertion maximum offset = 0.2")
                .find("room for") != std::string::npos);
  check("less than all in a single event is refused",
        refused(" set insertion box points coordinates = -5e-3, -5e-3, -5e-3 : 5e-3, 9e-3, 9e-3\n"
                " set inserted number of particles at each time step = 100")
                .find("all 400 particles come in a single event") != std::string::npos);
  check("a missing file is refused",
        refused(" set insertion method = file\n set list of input files = nowhere.csv")
                .find("nowhere.csv cannot be read") != std::string::npos);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_volume();
  test_list_and_file();
  test_single_particle();
  test_large_particles_of_a_file();
  test_number_of_files();
  test_repeated_list();
  test_types();
  test_acceptance();
  test_removal();
  test_errors();
}
