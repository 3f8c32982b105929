#ifndef eunoe_simulation_patch_list_h
#define eunoe_simulation_patch_list_h

// For source files only, as it includes deal.II.

#include <deal.II/base/data_out_base.h>

#include <string>
#include <tuple>
#include <vector>

namespace eunoe {

/// Points, lines or cells with data, in the form in which deal.II writes them.
template <int dim>
class PatchList : public dealii::DataOutInterface<dim, 3>
{
protected:
  using Patch = dealii::DataOutBase::Patch<dim, 3>;

  /// Names the next data of every patch.
  /// @param n_components 3 for a vector
  void add_name(const std::string &name, const unsigned int n_components = 1)
  {
    const unsigned int first = n_data();
    names.insert(names.end(), n_components, name);
    if (n_components == 3)
      vectors.emplace_back(first, first + 2, name,
                           dealii::DataComponentInterpretation::component_is_part_of_vector);
  }
  unsigned int n_data() const { return static_cast<unsigned int>(names.size()); }

  std::vector<Patch> patches;

private:
  using Ranges =
      std::vector<std::tuple<unsigned int, unsigned int, std::string,
                             dealii::DataComponentInterpretation::DataComponentInterpretation>>;

  const std::vector<Patch> &get_patches() const override { return patches; }
  std::vector<std::string> get_dataset_names() const override { return names; }
  Ranges get_nonscalar_data_ranges() const override { return vectors; }

  std::vector<std::string> names;
  Ranges vectors;
};

} // namespace eunoe

#endif
