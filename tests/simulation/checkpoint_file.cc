// The file of a checkpoint: every rank reads what was written, and a damaged file is refused on
// every rank with the place of the damage; one that a rank cannot read is not called damaged.
// Reference: rows follow from their keys, and the checksums are computed here, too, in another way.

#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/core/files.h>

#include "../tests.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

using namespace test;

namespace {

const std::string input = "set a = 1\n", path = "written.checkpoint", other = "other.checkpoint";
/// Of the format (bytes).
constexpr std::size_t chunk = 4194304, title = 19;
/// How a file is refused whose checksums are not right.
const std::string at_end = "is cut short, or damaged at its end: the checksums from byte ";

struct SectionOfTest
{
  std::string name;
  std::uint32_t n_rows;
};
/// Of three chunks, and of fewer rows than ranks.
const std::array<SectionOfTest, 2> sections = {{{"many", 150000}, {"few", 2}}};

int rank, n_ranks;

/// Length 0 to 14.
std::vector<double> row_of(const std::uint32_t key)
{
  std::vector<double> row(key % 15);
  std::iota(row.begin(), row.end(), 0.5 * key);
  return row;
}

void write_checkpoint()
{
  CheckpointWriter writer(MPI_COMM_WORLD);
  writer.head["input"] = input;
  for (const SectionOfTest &section : sections) {
    std::vector<std::uint32_t> keys;
    Rows rows;
    for (std::uint32_t key = 0; key < section.n_rows; ++key)
      if (static_cast<int>(key % static_cast<std::uint32_t>(n_ranks)) == rank) {
        const std::vector<double> row = row_of(key);
        keys.push_back(key);
        rows.append(row.data(), row.data() + row.size());
      }
    writer.add_rows(section.name, keys, std::move(rows));
  }
  writer.write(path);
}

bool everywhere(const bool ok)
{
  int all = ok ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return all != 0;
}

/// Whether a checkpoint holds what was written, each rank its share.
bool is_as_written(const std::string &file)
{
  const Checkpoint checkpoint(file, MPI_COMM_WORLD);
  bool ok = checkpoint.head.at("input").get<std::string>() == input;
  for (const SectionOfTest &section : sections) {
    const Rows &rows = checkpoint.rows(section.name);
    const auto first_of = [&section](const int of_rank) {
      return static_cast<std::size_t>(section.n_rows) * static_cast<std::size_t>(of_rank) /
             static_cast<std::size_t>(n_ranks);
    };
    ok = ok && rows.size() == first_of(rank + 1) - first_of(rank);
    for (std::size_t k = 0; ok && k < rows.size(); ++k) {
      const std::vector<double> row(rows[k], rows[k] + rows.length(k));
      ok = row == row_of(static_cast<std::uint32_t>(first_of(rank) + k));
    }
  }
  return everywhere(ok);
}

/// CRC-32 of IEEE 802.3, byte by byte.
std::uint32_t crc(const std::string &bytes, const std::size_t begin, const std::size_t end)
{
  static const std::array<std::uint32_t, 256> of_byte = [] {
    std::array<std::uint32_t, 256> table = {};
    for (std::uint32_t k = 0; k < 256; ++k) {
      std::uint32_t value = k;
      for (int bit = 0; bit < 8; ++bit)
        value = (value >> 1) ^ ((value & 1u) != 0 ? 0xedb88320u : 0u);
      table[k] = value;
    }
    return table;
  }();
  std::uint32_t value = 0xffffffffu;
  for (std::size_t k = begin; k < end; ++k)
    value = of_byte[(value ^ static_cast<unsigned char>(bytes[k])) & 0xffu] ^ (value >> 8);
  return value ^ 0xffffffffu;
}

template <typename Number>
std::string bytes_of(const Number number)
{
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// As every version ends.
std::string with_one_checksum(const std::string &bytes)
{
  return bytes + bytes_of<std::uint64_t>(crc(bytes, 0, bytes.size()));
}

/// As the present version ends.
std::string with_checksums(std::string contents)
{
  const std::size_t n = contents.size();
  std::string of_chunks = bytes_of<std::uint64_t>(n);
  for (std::size_t begin = 0; begin < n; begin += chunk)
    of_chunks += bytes_of(crc(contents, begin, std::min(begin + chunk, n)));
  return with_one_checksum(contents + of_chunks);
}

std::string with_flipped_bit(std::string bytes, const std::size_t place)
{
  bytes.at(place) = static_cast<char>(bytes.at(place) ^ 1);
  return bytes;
}

std::string with_version(std::string bytes, const char version)
{
  bytes.at(title - 2) = version;
  return bytes;
}

void write_other(const std::string &bytes)
{
  if (is_first_rank())
    std::ofstream(other, std::ios::binary) << bytes;
  MPI_Barrier(MPI_COMM_WORLD);
}

/// What is said on every rank of a file.
/// @param file its name on this rank
std::string answer_to(const std::string &file)
{
  std::string text = "It is read.";
  try {
    const Checkpoint checkpoint(file, MPI_COMM_WORLD);
  } catch (const DamagedCheckpoint &error) {
    text = std::string("Damage: ") + error.what();
  } catch (const UserError &error) {
    text = std::string("Refused: ") + error.what();
  }
  const std::string of_first = broadcast(text, MPI_COMM_WORLD);
  return everywhere(text == of_first) ? text : "The ranks say different things.";
}

/// What is said on every rank of a file of these bytes.
std::string answer(const std::string &bytes)
{
  write_other(bytes);
  return answer_to(other);
}

void expect(const std::string &name, const std::string &bytes, const std::string &sentence,
            const std::string &kind = "Damage: ")
{
  const std::string text = answer(bytes),
                    wanted = kind + "The checkpoint " + other + " " + sentence;
  check(name, text == wanted, "got '" + text + "'");
}

/// What is said of a damage between two bytes.
std::string damage(const std::size_t first, const std::size_t last, const std::string &more = "")
{
  return "is damaged: its bytes " + std::to_string(first) + " to " + std::to_string(last) +
         " are not as they were written" + more + ".";
}

void check_damages(const std::string &file, const std::size_t n, const std::size_t n_head)
{
  const auto flip = [&file](const std::size_t place) { return with_flipped_bit(file, place); };
  const std::string in_first = damage(0, chunk - 1), in_last = damage(2 * chunk, n - 1);
  expect("length of the head", flip(title + 3), in_first);
  expect("bracket of the head", flip(title + 8), in_first);
  expect("input of the head", flip(file.find("set a")), in_first);
  expect("number of rows", flip(file.find("\"rows\":15") + 8), in_first);
  expect("length of a row", flip(title + 8 + n_head + 40), in_first);
  expect("second chunk", flip(chunk), damage(chunk, 2 * chunk - 1));
  expect("its last byte", flip(2 * chunk - 1), damage(chunk, 2 * chunk - 1));
  expect("last chunk", flip(2 * chunk), in_last);
  expect("last byte", flip(n - 1), in_last);
  expect("two chunks", with_flipped_bit(flip(chunk + 7), n - 7), damage(chunk, n - 1));
  expect("two places", with_flipped_bit(flip(7 + title), n - 7),
         damage(0, chunk - 1, ", nor are further ones up to byte " + std::to_string(n - 1)));

  const std::string table = at_end + std::to_string(n) + " on do not fit.";
  expect("length of the contents", flip(n + 1), table);
  expect("checksum of a chunk", flip(n + 8 + 5), table);
  expect("checksum of all", flip(n + 8 + 12), table);
  expect("its zeros", flip(n + 8 + 19), table);
  const std::string half = answer(file.substr(0, n / 2));
  check("half a file", half.find(at_end) != std::string::npos, "got '" + half + "'");
  const std::string longer = answer(file + "a");
  check("a byte too many", longer.find(at_end) != std::string::npos, "got '" + longer + "'");
  expect("title", flip(0), "is no checkpoint of Eunoe.");
}

void check_versions(const std::string &file, const std::string &contents, const std::size_t n_head)
{
  // What a program reads that knows no checksums of chunks.
  const std::string all_before = file.substr(0, file.size() - 8);
  check("an older program sees that it is whole", with_one_checksum(all_before) == file);

  const std::string older = with_one_checksum(with_version(contents, '6'));
  write_other(older);
  check("version before", is_as_written(other));
  const std::string unknown_place = "is cut short or damaged: its checksum does not fit.";
  for (const std::size_t place : {title + 8 + n_head + 40, chunk + 7, older.size() - 8})
    expect("version before, damaged", with_flipped_bit(older, place), unknown_place);
  expect("version before, half", older.substr(0, chunk), unknown_place);
  expect("named like the version before", with_version(file, '6'), unknown_place);

  const std::string newer = with_one_checksum(with_version(all_before, '8'));
  const std::string version =
      "has version 8 of the format, and this program reads versions 6 and 7";
  expect("version behind", newer, version + ". Use the program that wrote it, or start anew.",
         "Refused: ");
  expect("version behind, damaged", with_flipped_bit(newer, chunk + 7),
         version + ", or it is damaged.");

  // Made like that, as the checksums say.
  expect("rows that do not fill",
         with_checksums(with_flipped_bit(contents, title + 8 + n_head + 40)),
         "is damaged: its rows do not fill their sections.");
  expect("no head", with_checksums(with_flipped_bit(contents, title + 8)),
         "is damaged: its head is not understood.");
}

/// Contents of exactly so many chunks or a byte more or less, without a row.
void check_lengths()
{
  const auto write_and_read = [](const std::size_t n_more) {
    CheckpointWriter writer(MPI_COMM_WORLD);
    writer.head["input"] = std::string(n_more, 'x');
    writer.add_rows("none", {}, Rows());
    const std::uint64_t size = writer.write(other);
    const Checkpoint checkpoint(other, MPI_COMM_WORLD);
    const bool ok = checkpoint.head.at("input").get<std::string>().size() == n_more &&
                    checkpoint.rows("none").size() == 0;
    return everywhere(ok) ? size : 0;
  };
  const auto behind = [](const std::size_t n) { return 8 + (n + chunk - 1) / chunk * 4 + 8; };
  const std::uint64_t least = write_and_read(0) - behind(1);
  for (const std::size_t n : {chunk - 1, chunk, chunk + 1, 2 * chunk}) {
    check("contents of " + std::to_string(n) + " bytes",
          write_and_read(n - least) == n + behind(n));
    std::ifstream stream(other, std::ios::binary);
    const std::string file{std::istreambuf_iterator<char>(stream), {}};
    MPI_Barrier(MPI_COMM_WORLD);
    expect("the last of them", with_flipped_bit(file, n - 1),
           damage((n - 1) / chunk * chunk, n - 1));
    const std::string cut = answer(file.substr(0, n));
    check("cut off", cut.find(at_end) != std::string::npos, "got '" + cut + "'");
  }
}

/// Whether a file can be opened, and no byte of it be read.
bool fails(const std::string &file)
{
  std::FILE *const stream = std::fopen(file.c_str(), "rb");
  const bool does = stream != nullptr && std::fgetc(stream) == EOF && std::ferror(stream) != 0;
  if (stream != nullptr)
    std::fclose(stream);
  return does;
}

/// Files that only the last rank cannot read, as if its node alone had trouble.
void check_failures()
{
  const std::string folder = "folder.checkpoint";
  if (is_first_rank())
    std::filesystem::create_directory(folder);
  MPI_Barrier(MPI_COMM_WORLD);
  check("a folder cannot be read", fails(folder));
  // On Linux it has a length and no bytes, as a loopback has no speed.
  for (const std::string &file : {folder, std::string("/sys/class/net/lo/speed")}) {
    const std::string begin = "Refused: The checkpoint " + file + " cannot be read on ";
    const std::string text =
        everywhere(fails(file)) ? answer_to(rank == n_ranks - 1 ? file : path) : begin;
    check("not read by the last rank", text.compare(0, begin.size(), begin) == 0,
          "got '" + text + "'");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_first_rank())
    std::filesystem::remove(folder);
}

} // namespace

EUNOE_MPI_TEST()
{
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  write_checkpoint();
  check("as written", is_as_written(path));

  std::ifstream stream(path, std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  const std::string contents = file.substr(0, file.size() - 8 - 3 * 4 - 8);
  check("three chunks", contents.size() > 2 * chunk + 100 && contents.size() < 3 * chunk);
  check("checksums", with_checksums(contents) == file);
  std::uint64_t n_head = 0;
  std::memcpy(&n_head, file.data() + title, sizeof n_head);
  check_damages(file, contents.size(), n_head);
  check_versions(file, contents, n_head);
  check_lengths();
  check_failures();

  MPI_Barrier(MPI_COMM_WORLD);
  if (is_first_rank())
    for (const std::string &each : {path, other})
      std::remove(each.c_str());
}
