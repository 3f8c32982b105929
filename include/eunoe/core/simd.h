#ifndef eunoe_core_simd_h
#define eunoe_core_simd_h

#include <eunoe/core/vec3.h>

#include <cmath>
#include <cstdint>

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

/// Defines a kernel in several versions, as EUNOE_MULTIVERSION does, of a template whose first
/// parameter is the number of doubles in a vector register.
/// @param parameters and @p arguments in parentheses
#if defined(__x86_64__) && defined(EUNOE_INSTRUCTION_SETS)
#if defined(EUNOE_HAS_V4)
#define EUNOE_OF_V4(result, name, parameters, wide, arguments)                                     \
  __attribute__((noinline, target("arch=x86-64-v4"))) result name parameters                       \
  {                                                                                                \
    return wide<8> arguments;                                                                      \
  }
#else
#define EUNOE_OF_V4(result, name, parameters, wide, arguments)
#endif
#define EUNOE_BY_WIDTH(result, name, parameters, wide, arguments)                                  \
  EUNOE_OF_V4(result, name, parameters, wide, arguments)                                           \
  __attribute__((noinline, target("arch=x86-64-v3"))) result name parameters                       \
  {                                                                                                \
    return wide<4> arguments;                                                                      \
  }                                                                                                \
  __attribute__((noinline, target("default"))) result name parameters                              \
  {                                                                                                \
    return wide<4> arguments;                                                                      \
  }
#else
#define EUNOE_BY_WIDTH(result, name, parameters, wide, arguments)                                  \
  result name parameters                                                                           \
  {                                                                                                \
    return wide<4> arguments;                                                                      \
  }
#endif

#define EUNOE_ALWAYS_INLINE inline __attribute__((always_inline))

namespace eunoe::simd {

/// Four doubles that the compiler keeps in one register where the machine has one.
typedef double Four __attribute__((vector_size(32), may_alias));

/// Two doubles in a register of every machine.
typedef double Two __attribute__((vector_size(16), may_alias));

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

template <unsigned int W>
struct OfWidth
{
  typedef double type __attribute__((vector_size(8 * W), may_alias));
};
/// W doubles.
template <unsigned int W>
using Pack = typename OfWidth<W>::type;

template <unsigned int W>
EUNOE_ALWAYS_INLINE Pack<W> &pack(double *p)
{
  return *reinterpret_cast<Pack<W> *>(p);
}
template <unsigned int W>
EUNOE_ALWAYS_INLINE const Pack<W> &pack(const double *p)
{
  return *reinterpret_cast<const Pack<W> *>(p);
}

/// Square roots.
template <unsigned int W>
EUNOE_ALWAYS_INLINE Pack<W> root(const Pack<W> &x)
{
  Pack<W> r;
  for (unsigned int l = 0; l < W; ++l)
    r[l] = std::sqrt(x[l]);
  return r;
}

/// The quad that begins at an offset (bytes).
EUNOE_ALWAYS_INLINE const Four &four(const Quad *quads, const std::uint32_t offset)
{
  return *reinterpret_cast<const Four *>(reinterpret_cast<const char *>(quads) + offset);
}
EUNOE_ALWAYS_INLINE Four &four(Quad *quads, const std::uint32_t offset)
{
  return *reinterpret_cast<Four *>(reinterpret_cast<char *>(quads) + offset);
}

/// The components of four or eight quads at some offsets (bytes).
EUNOE_ALWAYS_INLINE void gather(const Quad *quads, const std::uint32_t *offsets, Pack<4> &x,
                                Pack<4> &y, Pack<4> &z, Pack<4> &w)
{
  x = four(quads, offsets[0]);
  y = four(quads, offsets[1]);
  z = four(quads, offsets[2]);
  w = four(quads, offsets[3]);
  transpose(x, y, z, w);
}
EUNOE_ALWAYS_INLINE void gather(const Quad *quads, const std::uint32_t *offsets, Pack<8> &x,
                                Pack<8> &y, Pack<8> &z, Pack<8> &w)
{
  const auto two = [&](unsigned int a, unsigned int b) __attribute__((always_inline))
  {
    return __builtin_shufflevector(four(quads, offsets[a]), four(quads, offsets[b]), 0, 1, 2, 3, 4,
                                   5, 6, 7);
  };
  const Pack<8> even_0 = two(0, 2), odd_0 = two(1, 3), even_4 = two(4, 6), odd_4 = two(5, 7);
  const Pack<8> xz_0 = __builtin_shufflevector(even_0, odd_0, 0, 8, 2, 10, 4, 12, 6, 14);
  const Pack<8> yw_0 = __builtin_shufflevector(even_0, odd_0, 1, 9, 3, 11, 5, 13, 7, 15);
  const Pack<8> xz_4 = __builtin_shufflevector(even_4, odd_4, 0, 8, 2, 10, 4, 12, 6, 14);
  const Pack<8> yw_4 = __builtin_shufflevector(even_4, odd_4, 1, 9, 3, 11, 5, 13, 7, 15);
  x = __builtin_shufflevector(xz_0, xz_4, 0, 1, 4, 5, 8, 9, 12, 13);
  y = __builtin_shufflevector(yw_0, yw_4, 0, 1, 4, 5, 8, 9, 12, 13);
  z = __builtin_shufflevector(xz_0, xz_4, 2, 3, 6, 7, 10, 11, 14, 15);
  w = __builtin_shufflevector(yw_0, yw_4, 2, 3, 6, 7, 10, 11, 14, 15);
}

/// Rows of four components.
template <unsigned int W>
EUNOE_ALWAYS_INLINE void rows(const Pack<W> &x, const Pack<W> &y, const Pack<W> &z,
                              const Pack<W> &w, Four *out)
{
  if constexpr (W == 4) {
    out[0] = x;
    out[1] = y;
    out[2] = z;
    out[3] = w;
    transpose(out[0], out[1], out[2], out[3]);
  } else {
    const Pack<8> xy_even = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack<8> xy_odd = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
    const Pack<8> zw_even = __builtin_shufflevector(z, w, 0, 8, 2, 10, 4, 12, 6, 14);
    const Pack<8> zw_odd = __builtin_shufflevector(z, w, 1, 9, 3, 11, 5, 13, 7, 15);
    out[0] = __builtin_shufflevector(xy_even, zw_even, 0, 1, 8, 9);
    out[1] = __builtin_shufflevector(xy_odd, zw_odd, 0, 1, 8, 9);
    out[2] = __builtin_shufflevector(xy_even, zw_even, 2, 3, 10, 11);
    out[3] = __builtin_shufflevector(xy_odd, zw_odd, 2, 3, 10, 11);
    out[4] = __builtin_shufflevector(xy_even, zw_even, 4, 5, 12, 13);
    out[5] = __builtin_shufflevector(xy_odd, zw_odd, 4, 5, 12, 13);
    out[6] = __builtin_shufflevector(xy_even, zw_even, 6, 7, 14, 15);
    out[7] = __builtin_shufflevector(xy_odd, zw_odd, 6, 7, 14, 15);
  }
}

} // namespace eunoe::simd

#endif
