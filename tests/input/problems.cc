// All errors of an input file are reported at once, each with its place and how to mend it.

#include "../tests.h"

using namespace test;

namespace {

std::string complaints(const std::string &text, const std::vector<std::string> &overrides = {})
{
  Problems problems;
  Parameters::read(text, "case.prm", overrides, problems);
  return problems.text();
}

void expect(const std::string &name, const std::string &text, const std::string &sentence,
            const std::vector<std::string> &overrides = {})
{
  const std::string all = complaints(text, overrides);
  check(name, all.find(sentence) != std::string::npos, "got '" + all + "'");
}

void test_syntax()
{
  expect("unknown entry", "subsection simulation control\n  set time stp = 1\nend\n",
         "case.prm:2: subsection 'simulation control' / entry 'time stp' is unknown. Did you mean "
         "'time step'?");
  expect("unknown subsection", "subsection simulation controll\n  set time step = 1\nend\n",
         "case.prm:1: subsection 'simulation controll' is unknown. Did you mean 'simulation "
         "control'?");
  expect("unknown subsection without entries", "subsection Mesh\nend\n",
         "case.prm:1: subsection 'Mesh' is unknown. Did you mean 'mesh'?");
  expect("wrong type", "subsection simulation control\n  set time step = fast\nend\n",
         "case.prm:2: subsection 'simulation control' / entry 'time step' is 'fast', which does "
         "not fit. Give a number of at least 0, or 'auto'.");
  expect(
      "negative count", "subsection simulation control\n  set output frequency = -2\nend\n",
      "entry 'output frequency' is '-2', which does not fit. Give a whole number of at least 0.");
  expect("no such choice", "subsection model parameters\n  set integration method = magic\nend\n",
         "entry 'integration method' is 'magic', which does not fit. Give one of "
         "'explicit_euler', 'symplectic_euler', 'velocity_verlet'.");
  const std::string negative =
      complaints("subsection simulation control\n  set time step = -1e-3\nend\n");
  check("negative number, which is finite",
        negative.find("Give a number of at least 0, or 'auto'.") != std::string::npos &&
            negative.find("finite") == std::string::npos,
        "got '" + negative + "'");
  expect("too few numbers", "subsection lagrangian physical properties\n set g = 0, -9.81\nend\n",
         "entry 'g' is '0, -9.81', which does not fit. Give 3 values, each a number.");
  expect("missing end", "subsection mesh\n  set scale = 1\n",
         "case.prm: the subsection 'mesh' is still open at the end of the file. Add the missing "
         "'end'.");
  expect("end without beginning", "end\n", "case.prm:1: there is an 'end' without a 'subsection'");
  {
    Problems problems;
    Parameters::read("subsection mesh\ninclude part.prm\nset scale = 1\nend\n", "case.prm", {},
                     problems, [](const std::string &) { return std::string("end\n"); });
    check("end that an included file did not begin",
          problems.text().find("part.prm:1: there is an 'end' without") == 0, problems.text());
  }
  expect("nonsense", "hello\n", "case.prm:1: 'hello' is not understood.");
  expect("no value", "set process\n", "case.prm:1: 'set process' has no '='.");
  expect("override", "",
         "--set \"mesh/scales = 2\": subsection 'mesh' / entry 'scales' is unknown.",
         {"mesh/scales = 2"});
  expect("override with an empty part", "",
         "--set \"mesh//scale = 2\": its path has an empty part, as 'a//b' has.",
         {"mesh//scale = 2"});
  check("nothing else is said of it",
        complaints("", {"mesh//scale = 2"}).find("is unknown") == std::string::npos);
  expect("subsection beyond the number",
         "subsection floating walls\n  set number of floating walls = 1\n  subsection wall 1\n"
         "    set end time = 1\n  end\nend\n",
         "Raise 'number of floating walls', or remove the subsection.");
}

void test_values()
{
  const std::string types = "subsection lagrangian physical properties\n";
  expect("negative density",
         types + " subsection particle type 0\n  set density particles = -1\n end\nend\n",
         "entry 'density particles' is '-1', which does not fit.");
  expect("zero density",
         types + " subsection particle type 0\n  set density particles = 0\n end\nend\n",
         "case.prm:3: subsection 'lagrangian physical properties' / subsection 'particle type 0' / "
         "entry 'density particles' is 0 kg/m3. Give a positive density.");
  expect("classes that do not sum",
         types + " subsection particle type 0\n  set size distribution type = custom\n"
                 "  set custom distribution diameters values = 1e-3, 2e-3\n"
                 "  set custom distribution diameters probabilities = 0.5, 0.6\n end\nend\n",
         "sums to 1.1, not to 1.");
  expect("classes without shares",
         types + " subsection particle type 0\n  set size distribution type = custom\n"
                 "  set custom distribution diameters values = 1e-3, 2e-3, 3e-3\n end\nend\n",
         "has 2 values for 3 diameters.");
  expect("time step", "subsection simulation control\n set time step = 0\nend\n",
         "entry 'time step' is 0 s.");
  expect("one boundary with two conditions",
         "subsection DEM boundary conditions\n set number of boundary conditions = 2\n"
         " subsection boundary condition 0\n  set type = outlet\n end\nend\n",
         "names boundary 0, which has a condition already.");
  expect("wall that ends before it starts",
         "subsection floating walls\n set number of floating walls = 1\n subsection wall 0\n"
         "  set start time = 2\n  set end time = 1\n end\nend\n",
         "is 1 s, not after the start time of 2 s.");
}

const std::string spreading = "set process = powder spreading\nsubsection lagrangian physical "
                              "properties\n set g = 0, -9.81, 0\n"
                              " subsection particle type 0\n  set diameter = 70e-6\n end\nend\n";

void test_spreading()
{
  check("a spreading case in order", complaints(spreading).empty(), complaints(spreading));
  expect("spreader in the plate",
         spreading + "subsection powder spreading\n set spreader clearance delta_s = -1e-5\nend\n",
         "the spreader would stand inside the transfer plate.");
  expect("no layers", spreading + "subsection powder spreading\n set number of layers = 0\nend\n",
         "entry 'number of layers' is 0. Give at least 1 layer");
  expect("particles larger than the plate",
         spreading + "subsection powder spreading\n set length factor = 1e-3\nend\n",
         "less than three of the largest particles.");
  expect("gravity sideways",
         spreading + "subsection lagrangian physical properties\n set g = 0, 0, -9.81\nend\n",
         "does not point to -y.");
  expect("own mesh", spreading + "subsection mesh\n set scale = 2\nend\n",
         "is set, but the process makes its own. Remove the subsection.");
  expect("own end", spreading + "subsection simulation control\n set time end = 2\nend\n",
         "is set, but the process ends when its last layer is weighed. Remove the entry");
}

/// Errors that are found only when the domain has been made.
void test_domain()
{
  const auto refused = [](const std::string &text) -> std::string {
    try {
      Case test_case(text);
    } catch (const UserError &error) {
      return error.what();
    }
    return "";
  };
  const auto expect_refusal = [&](const std::string &name, const std::string &text,
                                  const std::string &sentence) {
    const std::string all = refused(text);
    check(name, all.find(sentence) != std::string::npos, "got '" + all + "'");
  };
  const std::string periodic = "subsection DEM boundary conditions\n"
                               " set number of boundary conditions = 1\n"
                               " subsection boundary condition 0\n  set type = periodic\n"
                               "  set periodic id 0 = 0\n  set periodic id 1 = ";
  expect_refusal("periodic boundaries that are not opposite",
                 box_input(1e-6, 1e-6, periodic + "2\n end\nend\n"),
                 "are not the two flat ends of the domain in the periodic direction.");
  expect_refusal("boundary that does not exist", box_input(1e-6, 1e-6, periodic + "9\n end\nend\n"),
                 "the mesh has no boundary 9.");
  expect_refusal("unknown grid", "subsection mesh\n set grid type = pretzel\nend\n",
                 "the mesh cannot be made");
  expect_refusal("solid that is no solid",
                 box_input(1e-6, 1e-6,
                           "subsection solid objects\n subsection solid surfaces\n  set number of "
                           "solids = 1\n  subsection solid object 0\n   subsection mesh\n    set "
                           "type = shape\n    set grid arguments = 0,0,0 : 1,0,0 : 2,0,0\n   end\n"
                           "  end\n end\nend\n"),
                 "triangle 0 is degenerate: its corners lie on one line");
}

} // namespace

EUNOE_MPI_TEST()
{
  test_syntax();
  test_values();
  test_spreading();
  test_domain();
  const std::string both = complaints("subsection mesh\n set scale = 0\n set type = gmsh\nend\n");
  check("all at once",
        both.find("'scale'") != std::string::npos && both.find("'file name'") != std::string::npos);
}
