#include <eunoe/core/files.h>
#include <eunoe/core/table.h>
#include <eunoe/processes/heap/measurement.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::heap {

MeasuredProfile read_profile(const std::string &file)
{
  const Table table = parse_table(read_file(file, MPI_COMM_SELF), file);
  const int x = table.column("x"), height = table.column("height");
  if (x < 0 || height < 0)
    throw UserError(file + ": it has no column '" + (x < 0 ? "x" : "height") +
                    "'. Give the columns 'x' and 'height', in m.");
  MeasuredProfile profile;
  for (const auto &row : table.rows) {
    if (!std::isfinite(row[x]) || !std::isfinite(row[height]) ||
        (!profile.x.empty() && row[x] <= profile.x.back()))
      throw UserError(file + ": row " + std::to_string(profile.x.size() + 1) +
                      " does not lie behind the one before, or is not finite. Sort the rows by x, "
                      "each place once.");
    profile.x.push_back(row[x]);
    profile.height.push_back(row[height]);
  }
  if (profile.x.size() < 2)
    throw UserError(file + ": it has fewer than two rows. Give the whole profile.");
  return profile;
}

double MeasuredProfile::at(const double place) const
{
  if (place < x.front() || place > x.back())
    return std::numeric_limits<double>::quiet_NaN();
  const std::size_t right =
      std::max<std::ptrdiff_t>(1, std::lower_bound(x.begin(), x.end(), place) - x.begin());
  const double share = (place - x[right - 1]) / (x[right] - x[right - 1]);
  return height[right - 1] + share * (height[right] - height[right - 1]);
}

double MeasuredProfile::area() const
{
  double sum = 0.;
  for (std::size_t k = 0; k + 1 < x.size(); ++k)
    sum += 0.5 * (height[k] + height[k + 1]) * (x[k + 1] - x[k]);
  return sum;
}

} // namespace eunoe::heap
