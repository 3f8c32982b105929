#include <eunoe/core/declare.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/solids/shapes.h>
#include <eunoe/solids/solid_parameters.h>

namespace eunoe {

namespace {

const ParameterCheck::Path surfaces_section = {"solid objects", "solid surfaces"};

std::string object_section(std::size_t k)
{
  return "solid object " + std::to_string(k);
}

ParameterCheck::Path path_of(std::size_t k, const std::string &subsection = "")
{
  ParameterCheck::Path path = surfaces_section;
  path.push_back(object_section(k));
  if (!subsection.empty())
    path.push_back(subsection);
  return path;
}

TriangleMesh make_mesh(const SolidObject &object, MPI_Comm comm)
{
  TriangleMesh mesh;
  if (object.type == "gmsh")
    mesh = read_gmsh(object.file, comm);
  else if (object.type == "dealii")
    mesh = generate_surface(object.shape, object.arguments, object.refinement);
  else {
    ShapeArguments arguments(object.arguments);
    mesh = named_shapes().make(object.shape, arguments);
    arguments.finish();
  }
  for (Vec3 &vertex : mesh.vertices)
    vertex = object.placement(vertex) - object.centre;
  const std::string defect = mesh.defect();
  if (!defect.empty())
    throw std::invalid_argument("the surface cannot be used: " + defect);
  return mesh;
}

} // namespace

MotionRegistry &solid_motions()
{
  static MotionRegistry registry("motion of solids");
  return registry;
}

std::shared_ptr<const Motion> SolidObject::make_motion(const double time_step) const
{
  std::shared_ptr<const Motion> found;
  std::string name_of_found;
  for (const auto &[name, section] : motions)
    if (std::shared_ptr<const Motion> motion = section->make(centre, time_step)) {
      if (found)
        throw std::invalid_argument("has two motions, '" + name_of_found + "' and '" + name +
                                    "'. Leave the entries of one at their defaults.");
      found = motion;
      name_of_found = name;
    }
  return found ? found : std::make_shared<AtRest>(centre);
}

void SolidObjectParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, surfaces_section[0]);
  declare::enter(prm, surfaces_section[1]);
  declare::number_of(prm, "number of solids", objects.size(), 0, 50,
                     "Number of the subsections 'solid object 0', 'solid object 1', ...");
  for (std::size_t k = 0; k < objects.size(); ++k) {
    SolidObject &object = objects[k];
    declare::enter(prm, object_section(k));
    declare::enter(prm, "mesh");
    declare::choice(prm, "type", object.type, "gmsh|shape|dealii",
                    "Origin of the surface: a Gmsh file of triangles, a shape made in code, or a "
                    "generator of deal.II, in the plane z = 0 or hyper_sphere.");
    declare::file(prm, "file name", object.file, "gmsh: the file.");
    declare::entry(prm, "grid type", object.shape,
                   "shape: which one (see 'grid arguments'). dealii: name of the generator.");
    declare::entry(
        prm, "grid arguments", object.arguments,
        "shape: its arguments (m). plane: corner : edge : edge. box: lower : upper. "
        "cylinder_shell: centre of one end : axis : radius : facets. disc: centre of the "
        "lower end of the rim : axis to the face : radius : facets. half_round_bar: "
        "start of the lowest line : length in z : radius : height : facets. "
        "flat_blade: start of the front lower edge : length in z : thickness : "
        "height. dealii: those of the generator.");
    declare::between(prm, "initial refinement", object.refinement, 0, 8,
                     "dealii: number of times that every cell is cut into four.");
    declare::entry(prm, "simplex", object.simplex, "Must be true: surfaces are made of triangles.");
    object.placement.declare(prm);
    declare::leave(prm);
    declare::vector(prm, "center of rotation", object.centre,
                    "Centre of rotation at the start, which moves with the solid (m).");
    declare::entry(prm, "output solid object", object.output, "Whether the solid is drawn.");
    for (auto &[name, motion] : object.motions)
      motion->declare(prm);
    declare::leave(prm);
  }
  declare::leave(prm);
  declare::leave(prm);
}

void SolidObjectParameters::check(const ParameterCheck &check) const
{
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const SolidObject &object = objects[k];
    const auto path = path_of(k, "mesh");
    check.require(object.type != "gmsh" || object.file != "none", path, "file name",
                  "is missing while the type is 'gmsh'.", "Name the file, or set type = shape.");
    check.require(object.type != "shape" || named_shapes().has(object.shape), path, "grid type",
                  "is '" + shortened(object.shape) + "', which is no shape.",
                  "Give one of " + named_shapes().names() +
                      ", or set type = dealii for a generator of deal.II.");
    check.require(object.simplex, path, "simplex", "is false.",
                  "Surfaces of solids are made of triangles: set it to true.");
    object.placement.check(check, path);
    for (const auto &[name, motion] : object.motions)
      motion->check(check, path_of(k));
  }
}

std::vector<Solid> SolidObjectParameters::make(const int material, const double time_step,
                                               MPI_Comm comm, Problems &problems) const
{
  std::vector<Solid> solids;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const SolidObject &object = objects[k];
    Solid solid;
    solid.name = object_section(k);
    solid.object = static_cast<unsigned int>(k);
    solid.material = material;
    solid.output = object.output;
    try {
      solid.shape = std::make_shared<TriangulatedSurface>(make_mesh(object, comm));
    } catch (const std::exception &error) {
      std::string what = error.what();
      const bool is_sentence = what.back() == '.';
      problems.add(describe(path_of(k, "mesh"), "") + ":", what + (is_sentence ? "" : "."),
                   is_sentence ? "" : "Correct the file, or 'grid arguments' as its text says.");
      continue;
    }
    try {
      solid.motion = object.make_motion(time_step);
    } catch (const std::exception &error) {
      problems.add(describe(path_of(k), "") + ":", error.what(), "");
      continue;
    }
    solids.push_back(solid);
  }
  return solids;
}

} // namespace eunoe
