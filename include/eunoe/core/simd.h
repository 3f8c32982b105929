#ifndef eunoe_core_simd_h
#define eunoe_core_simd_h

#include <eunoe/core/vec3.h>

/// Compiles a kernel for several instruction sets (the option EUNOE_INSTRUCTION_SETS of CMake) and
/// picks one when the program starts. All of them round every operation alike (the project is built
/// without contraction of multiply-add), so the choice changes the speed of a run and never its
/// bits; tests/instruction_sets compares them.
#if defined(EUNOE_NO_KERNELS)
#define EUNOE_MULTIVERSION                                                                         \
  _Pragma("GCC error \"Kernels are compiled for several instruction sets in source/contact and "   \
          "source/engine/integrators alone: move the file there, or add its folder to "            \
          "EUNOE_VECTOR_SOURCES in CMakeLists.txt.\"")
#elif defined(__x86_64__) && defined(EUNOE_INSTRUCTION_SETS)
#define EUNOE_MULTIVERSION __attribute__((noinline, target_clones(EUNOE_INSTRUCTION_SETS)))
#else
#define EUNOE_MULTIVERSION
#endif

#define EUNOE_ALWAYS_INLINE inline __attribute__((always_inline))

namespace eunoe::simd {

/// Four doubles that the compiler keeps in one register where the machine has one.
typedef double Four __attribute__((vector_size(32), may_alias));

EUNOE_ALWAYS_INLINE Four &four(Quad &q)
{
  return reinterpret_cast<Four &>(q);
}
EUNOE_ALWAYS_INLINE const Four &four(const Quad &q)
{
  return reinterpret_cast<const Four &>(q);
}
EUNOE_ALWAYS_INLINE Four &four(double *p)
{
  return *reinterpret_cast<Four *>(p);
}
EUNOE_ALWAYS_INLINE const Four &four(const double *p)
{
  return *reinterpret_cast<const Four *>(p);
}

/// Transposes the 4x4 matrix with rows a, b, c, d in place.
EUNOE_ALWAYS_INLINE void transpose(Four &a, Four &b, Four &c, Four &d)
{
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Four ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

} // namespace eunoe::simd

#endif
