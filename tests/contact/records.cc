// Records of contacts that began and ended in any order are laid out in the order of a list, and
// keep what they remember.

#include <eunoe/contact/pair_memory.h>

#include "../tests.h"

#include <algorithm>

using namespace test;

namespace {

constexpr unsigned int length = 6;

std::vector<double> read(const PairMemory &memory, const std::int32_t record)
{
  std::vector<double> values(length);
  memory.read(record, values.data());
  return values;
}

} // namespace

EUNOE_TEST()
{
  PairMemory memory;
  memory.clear(length);
  memory.lanes.assign(8, length);
  constexpr std::int32_t in_lane = 3;

  // Every third contact ends, and the places of those that ended are taken in turn.
  std::vector<std::int32_t> records(60);
  for (std::int32_t &record : records)
    record = memory.create();
  for (std::size_t k = 0; k < records.size(); k += 3) {
    memory.release(records[k]);
    records[k] = ContactMemory::none;
  }
  for (std::size_t k = 0; k < records.size(); k += 6)
    records[k] = memory.create();
  records[3] = in_lane;

  std::vector<std::vector<double>> before;
  for (std::size_t k = 0; k < records.size(); ++k)
    if (records[k] != ContactMemory::none && records[k] != in_lane)
      memory.write(records[k], std::vector<double>(length, static_cast<double>(k)).data());
  std::vector<std::int32_t> living;
  for (const std::int32_t record : records)
    if (record != ContactMemory::none && record != in_lane) {
      before.push_back(read(memory, record));
      living.push_back(record);
    }
  check("records lie anywhere", !std::is_sorted(living.begin(), living.end()));

  memory.sort_pool(records);
  bool same = true;
  std::size_t n = 0;
  living.clear();
  for (const std::int32_t record : records)
    if (record != ContactMemory::none && record != in_lane) {
      same = same && n < before.size() && read(memory, record) == before[n++];
      living.push_back(record);
    }
  check("they are in the order of the list",
        std::is_sorted(living.begin(), living.end()) &&
            living.back() - living.front() + 1 == static_cast<std::int32_t>(living.size()));
  check("and keep what they remember", same && n == before.size());
  check("pairs without a record, and one in a lane, stay",
        records[9] == ContactMemory::none && records[3] == in_lane);

  const std::int32_t next = memory.create();
  check("a new contact gets another record",
        std::find(records.begin(), records.end(), next) == records.end());
  check("of zeros", read(memory, next) == std::vector<double>(length, 0.));
}
