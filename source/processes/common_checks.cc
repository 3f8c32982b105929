#include <eunoe/processes/common_checks.h>

namespace eunoe {

namespace {

const ParameterCheck::Path powder = {"lagrangian physical properties"};

} // namespace

void require_one_type(const Parameters &parameters, const ParameterCheck &check,
                      const std::string &who)
{
  const std::size_t n_types = parameters.physics.types.size();
  check.require(n_types == 1, powder, "number of particle types",
                "is " + std::to_string(n_types) + ".",
                who + " works with one type; give the size classes as a custom distribution.");
}

void check_gravity_of_process(const Parameters &parameters, const ParameterCheck &check,
                              const std::string &why)
{
  const Vec3 &g = parameters.physics.gravity;
  check.require(g.y < 0. && g.x == 0. && g.z == 0., powder, "g", "does not point to -y.",
                "Set it to 0, -9.81, 0: " + why + ".");
}

void refuse_decisions_of_process(const ParameterCheck &check, const std::string &end,
                                 const std::string &bound)
{
  for (const char *const section :
       {"mesh", "box refinement", "DEM boundary conditions", "insertion info"})
    check.require(!check.has_changes(section), {section}, "",
                  "is set, but the process makes its own.", "Remove the subsection.");
  for (const char *const entry : {"end control", "time end", "iteration end"})
    check.require(!check.is_changed({"simulation control"}, entry), {"simulation control"}, entry,
                  "is set, but the process ends when " + end + ".",
                  "Remove the entry; " + bound + " the length of the run.");
}

} // namespace eunoe
