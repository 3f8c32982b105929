// Surfaces made in code have the area, the extent and the open edges that formulas give for their
// shapes; arguments that make no sense are refused with a sentence.

#include "surfaces.h"

using namespace test;

namespace {

/// Compares a named shape with the expected values.
void examine(const std::string &name, const std::string &text, double expected_area,
             double expected_open_length, const Box &expected_box)
{
  ShapeArguments arguments(text);
  const TriangleMesh mesh = named_shapes().make(name, arguments);
  arguments.finish();
  check("defect of " + name, mesh.defect().empty(), mesh.defect());
  check_relative("area of " + name, area(mesh), expected_area, 1e-13);
  check_close("length of the open edges of " + name, open_length(mesh), expected_open_length,
              1e-13);
  const Box box = TriangulatedSurface(mesh).bounding_box();
  check_close("extent of " + name,
              norm(box.lower - expected_box.lower) + norm(box.upper - expected_box.upper), 0.,
              1e-15);
}

/// Compares the message about arguments that make no sense.
void examine_error(const std::string &name, const std::string &text, const std::string &sentence)
{
  std::string answer = "nothing";
  try {
    ShapeArguments arguments(text);
    named_shapes().make(name, arguments);
    arguments.finish();
  } catch (const std::invalid_argument &error) {
    answer = error.what();
  }
  check("'" + text + "' for " + name, answer == sentence, answer);
}

void examine_flat()
{
  examine("plane", "1e-3, 0, 2e-3 : 3e-3, 0, 4e-3 : 0, 2e-3, 0", 5e-3 * 2e-3, 2. * (5e-3 + 2e-3),
          {{1e-3, 0., 2e-3}, {4e-3, 2e-3, 6e-3}});
  examine("box", "-1e-3, 0, 1e-3 : 1e-3, 3e-3, 6e-3", 2. * (6e-6 + 10e-6 + 15e-6), 0.,
          {{-1e-3, 0., 1e-3}, {1e-3, 3e-3, 6e-3}});
}

void examine_round()
{
  // A multiple of four facets has corners on all four sides.
  const double R = 2e-3, facet = 2. * R * std::sin(M_PI / 24.);
  examine("cylinder_shell", "1e-3, 2e-3, 3e-3 : 0, 0, 5e-3 : 2e-3 : 24", 24 * facet * 5e-3,
          2. * 24 * facet, {{-1e-3, 0., 3e-3}, {3e-3, 4e-3, 8e-3}});
  const TriangleMesh tilted = shapes::cylinder_shell({1., 2., 3.}, {3., 0., 4.}, 2., 24);
  double off_axis = 0.;
  const Vec3 along = {0.6, 0., 0.8};
  for (const Vec3 &x : tilted.vertices) {
    const Vec3 d = x - Vec3{1., 2., 3.};
    off_axis = std::max(off_axis, std::abs(norm(d - dot(d, along) * along) - 2.));
  }
  check_close("corners of a tilted cylinder off its radius", off_axis, 0., 1e-14);
  check_relative("area of a tilted cylinder", area(tilted),
                 24 * 2. * 2. * std::sin(M_PI / 24.) * 5., 1e-13);

  // The face is a polygon of 24 triangles, and only the lower edge of the rim is open.
  examine("disc", "1e-3, -1e-3, 3e-3 : 0, 1e-3, 0 : 2e-3 : 24",
          24 * facet * 1e-3 + 12. * R * R * std::sin(M_PI / 12.), 24 * facet,
          {{-1e-3, -1e-3, 1e-3}, {3e-3, 0., 5e-3}});
}

void examine_spreaders()
{
  const double half_facet = 2. * 0.4e-3 * std::sin(M_PI / 2. / 32.), sides = 2. * (1e-3 - 0.4e-3);
  examine("half_round_bar", "1e-3, 0.1e-3, 0 : 2e-3 : 0.4e-3 : 1e-3 : 32",
          (32 * half_facet + sides) * 2e-3, 2. * (32 * half_facet + sides) + 2. * 2e-3,
          {{0.6e-3, 0.1e-3, 0.}, {1.4e-3, 1.1e-3, 2e-3}});
  examine("half_round_bar", "0, 0, 0 : 2e-3 : 0.4e-3 : 0.4e-3 : 32", 32 * half_facet * 2e-3,
          2. * 32 * half_facet + 2. * 2e-3, {{-0.4e-3, 0., 0.}, {0.4e-3, 0.4e-3, 2e-3}});
  // With an odd number of facets the lowest one is flat, at the height of the lowest line.
  const double half_of_five = 0.4e-3 * std::sin(0.1 * M_PI),
               rise = 0.4e-3 * (1. - std::cos(0.1 * M_PI)),
               around = 10. * half_of_five + sides + 2. * rise;
  examine("half_round_bar", "0, 0.1e-3, 0 : 2e-3 : 0.4e-3 : 1e-3 : 5", around * 2e-3,
          2. * around + 2. * 2e-3, {{-0.4e-3, 0.1e-3, 0.}, {0.4e-3, 1.1e-3, 2e-3}});
  examine("flat_blade", "1e-3, 0.1e-3, 0 : 2e-3 : 0.3e-3 : 1e-3", (0.3e-3 + 2. * 1e-3) * 2e-3,
          2. * (0.3e-3 + 2. * 1e-3) + 2. * 2e-3, {{0.7e-3, 0.1e-3, 0.}, {1e-3, 1.1e-3, 2e-3}});
}

void examine_errors()
{
  examine_error("plane", "0,0,0 : 1,0,x : 0,0,1", "'x' is not a number");
  examine_error("plane", "0,0,0 : 1,0, : 0,0,1", "'' is not a number");
  examine_error("plane", "0,0,0 : 1,0 : 0,0,1", "argument 2 has 2 values instead of 3");
  examine_error("plane", "0,0,0 : 1,0,0", "there are too few arguments");
  examine_error("box", "0,0,0 : 1,1,1 : 2", "there are too many arguments");
  for (const std::string count : {"0", "-3", "2.5"})
    examine_error("cylinder_shell", "0,0,0 : 0,0,1 : 1 : " + count,
                  "argument 4 is no positive whole number");
  examine_error("cylinder_shell", "0,0,0 : 0,0,1 : 1 : 1e9", "argument 4 is more than 100000");
}

void examine_message()
{
  std::string message;
  try {
    Case test_case(box_input(
        1e-5, 1e-4, insertion_input({{}}) + shape_input("flat_blade", "0,0,0 : 1e-3 : 1e-4")));
  } catch (const UserError &error) {
    message = error.what();
  }
  check("the message names the solid",
        message ==
            "subsection 'solid objects' / subsection 'solid "
            "surfaces' / subsection 'solid object 0' / "
            "subsection 'mesh': there are too few arguments. Correct the file, or 'grid arguments' "
            "as its text says.",
        message);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_flat();
  examine_round();
  examine_spreaders();
  examine_errors();
  examine_message();
}
