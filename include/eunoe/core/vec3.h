#ifndef eunoe_core_vec3_h
#define eunoe_core_vec3_h

#include <cmath>

namespace eunoe {

/// A point or vector in space, SI units.
struct Vec3
{
  double x = 0., y = 0., z = 0.;

  Vec3 &operator+=(const Vec3 &b)
  {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  Vec3 &operator-=(const Vec3 &b)
  {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  Vec3 &operator*=(double s)
  {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }
  double &operator[](unsigned int c) { return c == 0 ? x : c == 1 ? y : z; }
  double operator[](unsigned int c) const { return c == 0 ? x : c == 1 ? y : z; }
};

inline Vec3 operator+(Vec3 a, const Vec3 &b)
{
  return a += b;
}
inline Vec3 operator-(Vec3 a, const Vec3 &b)
{
  return a -= b;
}
inline Vec3 operator-(const Vec3 &a)
{
  return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, Vec3 a)
{
  return a *= s;
}
inline Vec3 operator*(Vec3 a, double s)
{
  return a *= s;
}
inline Vec3 operator/(Vec3 a, double s)
{
  return {a.x / s, a.y / s, a.z / s};
}
inline bool operator==(const Vec3 &a, const Vec3 &b)
{
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
inline bool operator!=(const Vec3 &a, const Vec3 &b)
{
  return !(a == b);
}

inline double dot(const Vec3 &a, const Vec3 &b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3 &a, const Vec3 &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm_square(const Vec3 &a)
{
  return dot(a, a);
}
inline double norm(const Vec3 &a)
{
  return std::sqrt(norm_square(a));
}

/// Three components and a companion scalar in half a cache line: the hot state of a particle is
/// read and written by whole quads, one load for a random access instead of three or four.
struct alignas(32) Quad
{
  double x = 0., y = 0., z = 0., w = 0.;

  Vec3 vec() const { return {x, y, z}; }
  void set(const Vec3 &v)
  {
    x = v.x;
    y = v.y;
    z = v.z;
  }
  void add(const Vec3 &v)
  {
    x += v.x;
    y += v.y;
    z += v.z;
  }
};

} // namespace eunoe

#endif
