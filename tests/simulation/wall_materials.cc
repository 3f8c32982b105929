// Walls and solids with materials of their own: spheres hit a floating wall, a boundary and a solid
// of three materials, and a boundary of the common wall material. Each rebounds with the
// restitution of its pair; properties that a material does not set are those of the common one.

#include "../spheres.h"

using namespace test;

namespace {

std::string wall_material(int k, const std::string &surfaces, const std::string &entries)
{
  return "subsection wall material " + std::to_string(k) + "\n" +
         Scene::entry("surfaces", surfaces) + entries + "end\n";
}

double mean(double a, double b)
{
  return 2. * a * b / (a + b);
}

} // namespace

EUNOE_MPI_TEST()
{
  Scene s;
  s.floor = true;
  s.half_width = 8e-3;
  s.particle.restitution = 0.9;
  s.wall.restitution = 0.8;
  s.wall.young_modulus = 2e7;
  s.time_step = 1e-7;
  s.time_end = 2e-3;
  s.more = "subsection solid objects\nsubsection solid surfaces\n" +
           Scene::entry("number of solids", "1") + "subsection solid object 0\nsubsection mesh\n" +
           Scene::entry("type", "shape") + Scene::entry("grid type", "plane") +
           Scene::entry("grid arguments", "-2e-3,-4e-3,1e-3 : 4e-3,0,0 : 0,0,4e-3") +
           "end\nend\nend\nend\nsubsection lagrangian physical properties\n" +
           Scene::entry("number of wall materials", "3") +
           wall_material(0, "floating wall", Scene::entry("restitution coefficient wall", 0.2)) +
           wall_material(1, "boundary 0, boundary 2",
                         Scene::entry("restitution coefficient wall", 0.4) +
                             Scene::entry("restitution coefficient wall", "common") +
                             Scene::entry("restitution coefficient wall", 0.5)) +
           wall_material(2, "solid object 0",
                         Scene::entry("restitution coefficient wall", 0.3) +
                             Scene::entry("young modulus wall", 5e6)) +
           "end\n";
  const double speed = 1.;
  s.spheres.resize(4);
  const double gap = 0.1e-3, touching = s.spheres[0].radius() + gap;
  Sphere &above = s.spheres[0], &side = s.spheres[1], &solid = s.spheres[2], &other = s.spheres[3];
  above.x = {0., 0., touching};
  above.v = {0., 0., -speed};
  side.x = {-s.half_width + touching, 0., 3e-3};
  side.v = {-speed, 0., 0.};
  solid.x = {0., -4e-3 + touching, 3e-3};
  solid.v = {0., -speed, 0.};
  other.x = {s.half_width - touching, 0., 3e-3};
  other.v = {speed, 0., 0.};

  Case one(s.text());
  const Materials &materials = one->contact_model().get_materials();
  check("number of materials", materials.size() == 5 && materials.n_types() == 1);
  check("what is not set is common", materials[2].young_modulus == 2e7 &&
                                         materials[3].young_modulus == 2e7 &&
                                         materials[4].young_modulus == 5e6 &&
                                         materials[4].poisson_ratio == s.wall.poisson_ratio);
  one.run();
  const std::vector<Sphere> end = spheres_of(*one);
  check_relative("floating wall", end[0].v.z, mean(0.9, 0.2) * speed, 2e-3);
  check_relative("boundary of its own", end[1].v.x, mean(0.9, 0.5) * speed, 2e-3);
  check_relative("solid", end[2].v.y, mean(0.9, 0.3) * speed, 2e-3);
  check_relative("boundary of the common one", -end[3].v.x, mean(0.9, 0.8) * speed, 2e-3);
}
