#ifndef eunoe_core_registry_h
#define eunoe_core_registry_h

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace eunoe {

/// Ends the program with a sentence about its own code if plug-ins contradict each other. Most
/// register before `main`, where no exception can be caught.
[[noreturn]] void end_for_registration(const std::string &sentence);

/// A type of shared ownership: `std::unique_ptr` becomes `std::shared_ptr`.
///@{
template <typename Product>
struct Shared
{
  using type = Product;
};
template <typename Pointee>
struct Shared<std::unique_ptr<Pointee>>
{
  using type = std::shared_ptr<Pointee>;
};
///@}

/// Plug-ins of one kind by name. A plug-in's file holds one static `Registration`. A name that is
/// given twice ends the program when it starts.
template <typename Product, typename... Arguments>
class Registry
{
public:
  using Maker = std::function<Product(Arguments...)>;

  /// @param kind in a word or two, "contact law" for example
  explicit Registry(std::string kind) : kind(std::move(kind)) {}

  struct Registration
  {
    Registration(Registry &registry, const std::string &name, Maker maker)
    {
      if (!registry.makers.emplace(name, std::move(maker)).second)
        end_for_registration("The " + registry.kind + " '" + name +
                             "' is registered twice. Give one of the two another name.");
    }
  };

  bool has(const std::string &name) const { return makers.count(name) > 0; }

  Product make(const std::string &name, Arguments... arguments) const
  {
    const auto maker = makers.find(name);
    if (maker == makers.end())
      throw std::invalid_argument("there is no '" + name + "' among " + names());
    return maker->second(std::forward<Arguments>(arguments)...);
  }

  /// One product of each plug-in, by name. Copies of the map share the products, which do not
  /// change once the input is read.
  std::map<std::string, typename Shared<Product>::type> make_all() const
  {
    std::map<std::string, typename Shared<Product>::type> all;
    for (const auto &[name, maker] : makers)
      all[name] = maker();
    return all;
  }

  /// All names, in alphabetical order.
  std::vector<std::string> list() const
  {
    std::vector<std::string> all;
    for (const auto &entry : makers)
      all.push_back(entry.first);
    return all;
  }

  /// All names as "a|b|c", the pattern of a selection in an input file.
  std::string names() const
  {
    std::string all;
    for (const auto &entry : makers)
      all += (all.empty() ? "" : "|") + entry.first;
    return all;
  }

private:
  const std::string kind;
  std::map<std::string, Maker> makers;
};

/// A registry for each family of a kind of plug-ins. A family that does not exist ends the program
/// when it starts.
template <typename Registry>
class RegistryFamilies
{
public:
  RegistryFamilies(const std::string &kind, const std::vector<std::string> &families) : kind(kind)
  {
    for (const std::string &family : families)
      registries.emplace(family, family + " " + kind);
  }

  Registry &operator[](const std::string &family)
  {
    const auto registry = registries.find(family);
    if (registry == registries.end()) {
      std::string known;
      for (const auto &entry : registries)
        known += (known.empty() ? "'" : ", '") + entry.first + "'";
      end_for_registration("There is no " + kind + " of the family '" + family +
                           "'. The families are " + known + ".");
    }
    return registry->second;
  }

private:
  const std::string kind;
  std::map<std::string, Registry> registries;
};

} // namespace eunoe

#endif
