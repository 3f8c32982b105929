#include <eunoe/core/box_parts.h>

#include <algorithm>

namespace eunoe {

BoxParts::BoxParts(const Vec3 &lower, const Vec3 &upper, const PeriodicBox &box,
                   std::vector<Vec3> sample, const int n_parts)
    : lower(lower), upper(upper), box(box)
{
  nodes.reserve(static_cast<std::size_t>(n_parts));
  root = make(0, n_parts, lower, upper, sample.begin(), sample.end());
}

int BoxParts::make(const int first, const int last, const Vec3 &low, const Vec3 &high,
                   const Iterator begin, const Iterator end)
{
  if (last - first == 1)
    return -1 - first;
  unsigned int axis = 0;
  for (unsigned int d = 1; d < 3; ++d)
    if (high[d] - low[d] > high[axis] - low[axis])
      axis = d;
  const int middle = first + (last - first) / 2;
  const double share = static_cast<double>(middle - first) / (last - first);
  const Iterator at = begin + static_cast<std::ptrdiff_t>(share * static_cast<double>(end - begin));
  double cut = low[axis] + share * (high[axis] - low[axis]);
  if (at != end) {
    std::nth_element(begin, at, end,
                     [axis](const Vec3 &a, const Vec3 &b) { return a[axis] < b[axis]; });
    cut = std::min(std::max((*at)[axis], low[axis]), high[axis]);
  }
  const auto number = static_cast<int>(nodes.size());
  nodes.push_back({axis, cut, 0, 0});
  Vec3 below = high, above = low;
  below[axis] = above[axis] = cut;
  const int one = make(first, middle, low, below, begin, at);
  const int other = make(middle, last, above, high, at, end);
  nodes[number].first = one;
  nodes[number].second = other;
  return number;
}

int BoxParts::at(const Vec3 &x) const
{
  const Vec3 place = box.wrap(x);
  int child = root;
  while (child >= 0)
    child = place[nodes[child].axis] < nodes[child].cut ? nodes[child].first : nodes[child].second;
  return -1 - child;
}

void BoxParts::collect(const int child, const Vec3 &low, const Vec3 &high,
                       std::vector<int> &parts) const
{
  if (child < 0) {
    parts.push_back(-1 - child);
    return;
  }
  const Node &node = nodes[child];
  if (low[node.axis] < node.cut)
    collect(node.first, low, high, parts);
  if (high[node.axis] >= node.cut)
    collect(node.second, low, high, parts);
}

void BoxParts::near(const Vec3 &x, const double reach, std::vector<int> &parts) const
{
  parts.clear();
  const Vec3 place = box.wrap(x);
  // Images of the cube that stick into the box from the other end of a period.
  std::vector<Vec3> centres = {place};
  for (unsigned int d = 0; d < 3; ++d) {
    if (!box.is_periodic(d))
      continue;
    const std::size_t n = centres.size();
    for (const double shift : {-box.length[d], box.length[d]})
      for (std::size_t k = 0; k < n; ++k) {
        Vec3 image = centres[k];
        image[d] += shift;
        if (image[d] + reach >= box.origin[d] && image[d] - reach < box.origin[d] + box.length[d])
          centres.push_back(image);
      }
  }
  const Vec3 half = {reach, reach, reach};
  for (const Vec3 &centre : centres)
    collect(root, centre - half, centre + half, parts);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
}

} // namespace eunoe
