#include <eunoe/core/compat.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>
#include <eunoe/simulation/output.h>
#include <eunoe/simulation/patch_list.h>

#include "vtu_text.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace eunoe {

namespace {

/// Particles as points with data, in the form in which deal.II writes them.
class ParticlePatches : public PatchList<0>
{
public:
  ParticlePatches(const ParticleArrays &p, const ParticleFields &fields,
                  const std::vector<PictureField> &more)
  {
    for (const char *const name : {"type", "diameter", "mass"})
      add_name(name);
    add_name("velocity", 3);
    add_name("omega", 3);
    for (const ParticleField &field : fields.list())
      add_name(field.name, field.n_components);
    for (const PictureField &field : more)
      add_name(field.name, field.n_components);

    patches.resize(p.n_owned);
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      Patch &patch = patches[k];
      const Quad &x = p.position[k], &v = p.velocity[k], &w = p.spin[k];
      patch.vertices[0] = dealii::Point<3>(x.x, x.y, x.z);
      patch.patch_index = static_cast<unsigned int>(k);
      patch.data.reinit(n_data(), 1);
      const double values[] = {static_cast<double>(p.type[k]),
                               2. * p.radius(k),
                               p.mass(k),
                               v.x,
                               v.y,
                               v.z,
                               w.x,
                               w.y,
                               w.z};
      unsigned int c = 0;
      for (const double value : values)
        patch.data(c++, 0) = static_cast<float>(value);
      for (const std::vector<double> &values_of_all : p.extra)
        patch.data(c++, 0) = static_cast<float>(values_of_all[k]);
      for (const PictureField &field : more)
        for (unsigned int d = 0; d < field.n_components; ++d)
          patch.data(c++, 0) = static_cast<float>(field.values[k * field.n_components + d]);
    }
  }
};

/// The triangles of solids with the number of the solid as data.
std::vector<dealii::DataOutBase::Patch<2, 3>> solid_patches(const std::vector<Solid> &solids)
{
  std::vector<dealii::DataOutBase::Patch<2, 3>> patches;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!solids[s].output)
      continue;
    const RigidState &state = solids[s].state;
    const std::vector<Vec3> corners = solids[s].shape->triangles();
    for (std::size_t c = 0; c < corners.size(); c += 3) {
      dealii::DataOutBase::Patch<2, 3> patch;
      patch.reference_cell = dealii::ReferenceCells::Triangle;
      patch.n_subdivisions = 1;
      patch.patch_index = static_cast<unsigned int>(patches.size());
      patch.data.reinit(1, 3);
      for (unsigned int v = 0; v < 3; ++v) {
        const Vec3 x = state.centre + state.rotation.apply(corners[c + v]);
        patch.vertices[v] = dealii::Point<3>(x.x, x.y, x.z);
        patch.data(0, v) = static_cast<float>(s);
      }
      patches.push_back(patch);
    }
  }
  return patches;
}

} // namespace

std::string PictureSeries::next_file(const double time)
{
  char number[16];
  std::snprintf(number, sizeof number, "_%05zu.vtu", files.size());
  files.emplace_back(time, name + number);
  return files.back().second;
}

void PictureSeries::write_index() const
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                     "byte_order=\"LittleEndian\">\n  <Collection>\n";
  for (const auto &[time, file] : files) {
    char line[64];
    std::snprintf(line, sizeof line, "    <DataSet timestep=\"%.17g\" ", time);
    text += line + ("part=\"0\" file=\"" + file + "\"/>\n");
  }
  text += "  </Collection>\n</VTKFile>\n";
  on_first_rank(comm, [&] { write_file(folder + "/" + name + ".pvd", text); });
}

void PictureSeries::sync()
{
  for (; n_synced < files.size(); ++n_synced)
    sync_file(folder + "/" + files[n_synced].second);
}

void PictureSeries::resume(const Files &earlier)
{
  files = earlier;
  n_synced = files.size();
  write_index();
}

template <int dim>
void PictureSeries::write_in_parallel(const double time, dealii::DataOutInterface<dim, 3> &data,
                                      const std::vector<PictureIntegers> &integers)
{
  if (folder.empty())
    return;
  const std::string path = folder + "/" + next_file(time);
  data.set_flags(compat::vtu_flags(time, static_cast<unsigned int>(files.size())));
  std::ostringstream stream;
  data.write_vtu(stream);
  VtuText text(stream.str());
  for (auto array = integers.rbegin(); array != integers.rend(); ++array)
    text.add(*array);
  int rank, n_ranks, has_points = text.has_points() ? 1 : 0, any_has_points;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  MPI_Allreduce(&has_points, &any_has_points, 1, MPI_INT, MPI_MAX, comm);
  // ParaView needs at least one piece, but none without points in front of others.
  const bool has_piece = has_points != 0 || (any_has_points == 0 && rank == 0);
  write_in_parts(path,
                 (rank == 0 ? text.head : std::string()) +
                     (has_piece ? text.piece : std::string()) +
                     (rank == n_ranks - 1 ? text.tail : std::string()),
                 comm);
  write_index();
}

void PictureSeries::write(const double time, const ParticleArrays &particles,
                          const ParticleFields &fields, const std::vector<PictureField> &more)
{
  ParticlePatches patches(particles, fields, more);
  PictureIntegers ids{"ID", {}};
  ids.values.assign(particles.id.begin(),
                    particles.id.begin() + static_cast<std::ptrdiff_t>(particles.n_owned));
  write_in_parallel(time, patches, {ids});
}

void PictureSeries::write(const double time, dealii::DataOutInterface<3, 3> &cells)
{
  write_in_parallel(time, cells, {});
}

void PictureSeries::write(const double time, dealii::DataOutInterface<1, 3> &lines,
                          const std::vector<PictureIntegers> &integers)
{
  write_in_parallel(time, lines, integers);
}

void PictureSeries::write(const double time, const std::vector<Solid> &solids)
{
  if (folder.empty() ||
      std::none_of(solids.begin(), solids.end(), [](const Solid &s) { return s.output; }))
    return;
  const std::string path = folder + "/" + next_file(time);
  on_first_rank(comm, [&] {
    std::ostringstream text;
    dealii::DataOutBase::write_vtu(solid_patches(solids), {"solid"}, {},
                                   compat::vtu_flags(time, static_cast<unsigned int>(files.size())),
                                   text);
    write_file(path, text.str());
  });
  write_index();
}

} // namespace eunoe
