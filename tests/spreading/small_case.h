#ifndef eunoe_tests_spreading_small_case_h
#define eunoe_tests_spreading_small_case_h

#include <string>

namespace test {

constexpr double layer_thickness = 100e-6, slice_depth = 0.3e-3, plate_length = 0.6e-3,
                 density = 4386., later_stroke = 0.25e-3, margin = 0.15e-3, clearance = 110e-6;

/// An input text for two layers on a plate of 0.6 mm.
/// @param more entries of subsection powder spreading
/// @param others further subsections
inline std::string small_spreading(const std::string &folder, const std::string &more,
                                   const std::string &others = "")
{
  return R"(
set process = powder spreading
subsection simulation control
  set time step     = 1.2e-6
  set log frequency = 0
  set output path   = )" +
         folder + R"(
end
subsection lagrangian physical properties
  set g = 0, -9.81, 0
  subsection particle type 0
    set size distribution type = custom
    set custom distribution diameters values = 60e-6, 80e-6
    set custom distribution diameters probabilities = 0.5, 0.5
    set density particles = 4386
    set young modulus particles = 2.6e6
    set restitution coefficient particles = 0.6
    set friction coefficient particles = 0.4
  end
  set young modulus wall = 2.6e6
  set restitution coefficient wall = 0.6
  set friction coefficient wall = 0.4
end
subsection model parameters
  set rolling resistance torque method = epsd
end
subsection powder spreading
  set feedstock platform length W1 = 0.6e-3
  set transfer plate length W2 = 0.2e-3
  set measuring plate length W3 = 0.6e-3
  set exit plate length W4 = 0.2e-3
  set depth = 0.3e-3
  set gap = 0.1e-3
  set lip height = 0.3e-3
  set spreader radius R_s = 0.3e-3
  set spreader facets = 12
  set spreader clearance delta_s = 110e-6
  set number of layers = 2
  set spreading velocity v_s = 0.15
  set feedstock stroke delta_f = 0.25e-3
  set first feedstock stroke = 0.3e-3
  set feedstock margin = 0.15e-3
  set measuring plate velocity = 20e-3
  set feedstock platform velocity = 50e-3
  set feedstock insertion speed = 0.3
  set settled speed = 30e-3
  set spreader force sampling = 10
  set layer pictures = false
  set profile bins = 4
)" + more +
         "\nend\n" + others;
}

} // namespace test

#endif
