// Input files with Lethe's older names of entries mean the same as those with the present names;
// entries for fluids are ignored and those out of scope refused, each with one line. What has
// another default there, or other results, is said.

#include <eunoe/simulation/lethe_notes.h>

#include "tests.h"

using namespace eunoe;

namespace {

/// Entries whose names have not changed.
const std::string common_words = R"(
subsection simulation control
  set time step        = 1e-5
  set time end         = 2e-3
  set log frequency    = 0
  set output frequency = 0
end

subsection lagrangian physical properties
  subsection particle type 0
    set density particles                 = 2500
    set young modulus particles           = 1e6
    set poisson ratio particles           = 0.3
    set restitution coefficient particles = 0.9
    set friction coefficient particles    = 0.3
  end
  set young modulus wall = 1e6
end

subsection insertion info
  set inserted number of particles at each time step = 3
  set insertion frequency                            = 50
  set insertion distance threshold                   = 1.5
  subsection insertion acceptance function
    set Function expression = x - 0.05
  end
end

subsection model parameters
  set particle particle contact force method = hertz_mindlin_limit_overlap
  set particle wall contact force method     = nonlinear
end
)";

const std::string old_words = R"(
set dimension        = 3
set print parameters = none

subsection simulation control
  set method           = bdf1
  set group files      = 1
  set output time frequency = 1e-4
end

subsection timer
  set type = none
end

subsection test
  set enable = true
end

subsection mesh
  set type                                = dealii
  set grid type                           = hyper_rectangle
  set grid arguments                      = 0, 0, 0 : 0.1, 0.1, 0.1 : true
  set initial refinement                  = 2
  set initial boundary refinement         = 1
  set boundaries refined                  = 0, 1
  set expand particle-wall contact search = false
end

subsection box refinement
  set initial refinement = 1
  subsection mesh
    set grid type      = hyper_rectangle
    set grid arguments = 0, 0, 0 : 0.02, 0.02, 0.02 : false
    set simplex        = false
  end
end

subsection lagrangian physical properties
  set gz                       = -9.81
  set number of particle types = 1
  subsection particle type 0
    set size distribution type            = uniform
    set diameter                          = 0.005
    set number                            = 6
    set random seed distribution          = 3
    set size distribution type            = custom
    set custom diameters                  = 0.004, 0.005
    set custom volume fractions           = 0.4, 0.6
  end
end

subsection insertion info
  set insertion method                               = non_uniform
  set insertion box minimum x                        = 0.01
  set insertion box minimum y                        = 0.01
  set insertion box minimum z                        = 0.01
  set insertion box maximum x                        = 0.09
  set insertion box maximum y                        = 0.09
  set insertion box maximum z                        = 0.09
  set insertion random number range                  = 0.2
  set insertion random number seed                   = 7
  set velocity y                                     = 0.5
  set insertion first direction                      = 1
  set insertion second direction                     = 0
  set insertion third direction                      = 2
end

subsection model parameters
  set rolling resistance torque method       = constant_resistance
  set solver type                            = dem
  subsection dynamic disabling contacts
    set enable dynamic disabling contacts = false
    set solid fraction threshold          = 0.4
  end
end

subsection boundary forces
  set calculation = true
  set verbosity   = quiet
  set filename    = boundaries
end

subsection floating walls
  set number of floating walls = 1
  subsection wall 0
    subsection point on wall
      set z = 0.002
    end
    subsection normal vector
      set nz = 1
    end
    set end time = 1
  end
end

subsection solid objects
  set number of solids = 1
  subsection solid object 0
    subsection mesh
      set type           = shape
      set grid type      = box
      set grid arguments = 0.02, 0.02, 0.003 : 0.04, 0.04, 0.006
      set simplex        = true
    end
  end
end
)";

const std::string present_words = R"(
subsection simulation control
  set output time = 1e-4
end

subsection mesh
  set type               = dealii
  set grid type          = hyper_rectangle
  set grid arguments     = 0, 0, 0 : 0.1, 0.1, 0.1 : true
  set initial refinement = 2
end

subsection box refinement
  set number of refinement boxes = 1
  subsection box 0
    set additional refinement = 1
    subsection mesh
      set grid type      = hyper_rectangle
      set grid arguments = 0, 0, 0 : 0.02, 0.02, 0.02 : false
    end
  end
end

subsection lagrangian physical properties
  set g                        = 0, 0, -9.81
  set number of particle types = 1
  subsection particle type 0
    set size distribution type            = uniform
    set average diameter                  = 0.005
    set number of particles               = 6
    set distribution prn seed             = 3
    set size distribution type            = custom
    set distribution weighting basis                = volume
    set custom distribution diameters values        = 0.004, 0.005
    set custom distribution diameters probabilities = 0.4, 0.6
  end
end

subsection insertion info
  set insertion method                               = volume
  set insertion box points coordinates               = 0.01, 0.01, 0.01 : 0.09, 0.09, 0.09
  set insertion maximum offset                       = 0.2
  set insertion prn seed                             = 7
  set initial velocity                               = 0, 0.5, 0
  set insertion direction sequence                   = 1, 0, 2
end

subsection model parameters
  set rolling resistance torque method       = constant
  subsection adaptive sparse contacts
    set enable adaptive sparse contacts = false
  end
end

subsection boundary forces
  set calculation = true
  set filename    = boundaries
end

subsection floating walls
  set number of floating walls = 1
  subsection wall 0
    set point on wall = 0, 0, 0.002
    set normal vector = 0, 0, 1
    set end time      = 1
  end
end
)" + test::shape_input("box", "0.02, 0.02, 0.003 : 0.04, 0.04, 0.006\n set simplex = true");

void print_problems(const std::string &text)
{
  Problems problems;
  const Parameters parameters = Parameters::read(text, "case.prm", {}, problems);
  for (const Problem &problem : problems.all())
    test::print("refused: " + problem.text());
  for (const Problem &warning : problems.warnings())
    test::print("taken: " + warning.text());
  for (const std::string &note : parameters.lethe_notes)
    test::print("note: " + note);
}

/// The notes on an input that has no others than those on what @p text says.
void print_notes(const std::string &name, const std::string &text)
{
  const std::string without_notes =
      "set dimension = 3\nsubsection simulation control\n set output frequency = 10\nend\n"
      "subsection insertion info\n set insertion method = list\nend\n"
      "subsection model parameters\n set integration method = explicit_euler\nend\n";
  Problems problems;
  const std::vector<InputEntry> entries = parse_input(without_notes + text, "case.prm", problems);
  test::check("notes on " + name, problems.empty(), problems.text());
  for (const std::string &note : notes_for_lethe(entries))
    test::print("note: " + note);
}

/// What @p entries in 'model parameters' say.
std::string model(const std::string &entries)
{
  return "subsection model parameters\n" + entries + "end\n";
}

/// Laws of particles, by Lethe's names, and of walls.
std::string laws(const std::string &particles, const std::string &walls)
{
  return model(" set particle particle contact force method = " + particles +
               "\n set particle wall contact force method = " + walls + "\n");
}

const std::string turning_wall =
    "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
    " subsection boundary condition 0\n  set type = rotational\n"
    "  set rotational speed = 2\n end\nend\n";

/// A solid as in files of 2022, with an angular velocity.
std::string solid(const std::string &angular_velocity)
{
  return "subsection solid objects\n set number of solids = 1\n subsection solid object 0\n"
         "  subsection angular velocity\n   set Function expression = " +
         angular_velocity + "\n  end\n end\nend\n";
}

/// Coefficients of rolling friction of particles and walls.
std::string rolling_friction(const std::string &particles, const std::string &walls)
{
  return "subsection lagrangian physical properties\n subsection particle type 0\n"
         "  set rolling friction particles = " +
         particles + "\n end\n set rolling friction wall = " + walls + "\nend\n";
}

} // namespace

EUNOE_MPI_TEST()
{
  Problems of_old, of_present;
  const Parameters old = Parameters::read(old_words + common_words, "case.prm", {}, of_old);
  const Parameters present =
      Parameters::read(present_words + common_words, "case.prm", {}, of_present);
  test::check("old words are understood", of_old.empty());
  test::check("present words are understood", of_present.empty());
  test::check("present words give no warning", of_present.warnings().empty());
  test::check("both mean the same", old.as_input_file() == present.as_input_file());
  test::check("values are those of the text", values_in(old.as_input_file()) == old.entries());
  for (const Problem &warning : of_old.warnings())
    test::print(warning.text());

  print_problems("set dimension = 2\n");
  print_problems("subsection model parameters\n set solver type = dem_mp\nend\n");
  print_problems("subsection mesh\n set simplex = true\nend\n");
  print_problems(
      "subsection insertion info\n set list temperatures = 300\nend\n"
      "subsection lagrangian physical properties\n subsection particle type 0\n"
      "  set specific heat particles = 1000\n end\n set thermal conductivity gas = 0.01\n"
      "end\nsubsection solid objects\n subsection solid volumes\n"
      "  set number of solids = 0\n end\nend\n");
  print_problems("subsection simulation control\n set output times = 0.1, 0.3\n end\n"
                 "subsection insertion info\n set insertion order of direction = 2, 1, 0\n"
                 " subsection insertion acceptance function\n  set Variable names = x, y, z, t\n"
                 " end\nend\nsubsection box refinement\n set number of refinement boxes = 1\n"
                 " subsection box 0\n  set initial refinement = 1\n  subsection mesh\n"
                 "   set grid type = hyper_rectangle\n"
                 "   set grid arguments = 0, 0, 0 : 0.1, 0.1, 0.1 : false\n  end\n end\nend\n"
                 "subsection model parameters\n subsection load balancing\n"
                 "  set load balance method = dynamic_with_disabling_contacts\n"
                 "  subsection cell weight function\n   set Variable names = a, b, c, t\n"
                 "  end\n end\nend\n");
  print_problems("subsection simulation control\n set output time frequency = -1\n"
                 " set output times = -1\nend\n");
  print_problems("subsection mesh\n set type = cylinder\n set grid type = balanced\n"
                 " set grid arguments = 4 : 0.01 : 0.02\nend\n");
  print_problems(
      "subsection simulation control\n set output frequency = -1\n set log frequency = -1\n"
      "end\nsubsection DEM boundary conditions\n set number of boundary conditions = 1\n"
      " subsection boundary condition 0\n  set type = rotational\n"
      "  set rotational vector x = 0\n  set rotational vector z = 1\n end\nend\n");
  print_problems(
      "set dimension = 3\nsubsection insertion info\n set insertion method = list\n"
      " set list x = 0, 1\n set list y = 0, 0\n set list z = 0, 0\n"
      " set list velocity x = 0.5, 0.5\nend\nsubsection restart\n set restart = true\nend\n"
      "subsection model parameters\n set integration method = explicit_euler\n"
      " set particle particle contact force method = DMT\n"
      " set particle wall contact force method = DMT\n"
      " subsection load balancing\n  set load balance method = dynamic\n end\nend\n"
      "subsection lagrangian physical properties\n subsection particle type 0\n"
      "  set custom distribution interpolation = true\n end\nend\n");
  print_problems("set dimension = 3\nsubsection simulation control\n set output frequency = 10\n"
                 "end\nsubsection insertion info\n set insertion frequency = 7\nend\n"
                 "subsection mesh\n set expand particle-wall contact search = true\nend\n");

  print_notes("walls by default", model(" set particle particle contact force method = hertz\n"));
  print_notes("limited force", laws("hertz_mindlin_limit_force", "nonlinear"));
  print_notes("limited overlap", laws("hertz_mindlin_limit_overlap", "nonlinear"));
  print_notes("linear walls", laws("hertz", "linear"));
  print_notes("necks", laws("hertz_JKR", "nonlinear"));
  print_notes("necks at walls", laws("hertz_mindlin_limit_overlap", "JKR"));
  print_notes("linear particles", laws("linear", "linear") + rolling_friction("0.01", "0.1"));
  print_notes("linear particles with equal coefficients", laws("linear", "linear"));
  print_notes("linear particles without rolling resistance",
              laws("linear", "linear") + model(" set rolling resistance torque method = none\n"));
  print_notes("a drum", turning_wall);
  print_notes("a drum without rolling resistance",
              turning_wall + model(" set rolling resistance torque method = no_resistance\n"));
  print_notes("a drum without rolling friction", turning_wall + rolling_friction("0.1", "0"));
  print_notes("particles without rolling friction", turning_wall + rolling_friction("0.0", "0.1"));
  print_notes("a solid at rest", solid("0; 0.0 ;0"));
  print_notes("a solid that turns", solid("0; 0; if(t < 1, 0, 2)"));
  print_notes("a solid that turns without rolling friction",
              solid("w; 0; 0") + rolling_friction("0.1", "0"));
}
