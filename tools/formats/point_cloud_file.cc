#include "tools/formats/point_cloud_file.h"

#include <pcl/io/lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/input_error.h"
#include "tools/formats/number_text.h"
#include "tools/formats/point_record.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHeaderBytes = 65'536;
constexpr std::size_t kMostTextLine = 65'536;
constexpr std::uint64_t kMostCompressed_bytes = 1'000'000'000;

/// Anything wrong is told of as std::invalid_argument and gets the file's name at the border.
[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

/// A line without its end, which may be that of Windows. @return false at the end of the file
bool read_line(std::istream& file, std::string& line, std::size_t most) {
  line.clear();
  for (int c = file.get(); c != std::istream::traits_type::eof(); c = file.get()) {
    if (c == '\n') {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      return true;
    }
    if (line.size() == most) refuse("a line is longer than " + std::to_string(most) + " characters");
    line += static_cast<char>(c);
  }
  return !line.empty();
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Header lines as words, until `last` has been read. @return false if the file ended before
template <typename Use>
void for_each_header_line(std::istream& file, const std::string& last, Use use) {
  std::string line;
  std::size_t bytes = 0;
  while (read_line(file, line, kMostHeaderBytes)) {
    bytes += line.size() + 1;
    if (bytes > kMostHeaderBytes) refuse("its header is longer than 65536 bytes");
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    use(words);
    if (words.front() == last) return;
  }
  refuse("its header has no line '" + last + "'");
}

std::uint64_t count_from(const std::string& word) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc() || end != word.data() + word.size()) refuse("found '" + word + "' for a count");
  return count;
}

[[noreturn]] void ends_early(std::uint64_t points, std::uint64_t of) {
  refuse("it ends after " + std::to_string(points) + " of " + std::to_string(of) + " points");
}

void read_text(std::istream& file, const PointRecord& record, std::uint64_t points, const CloudListener& listener) {
  std::string line;
  std::vector<double> numbers(record.numbers());
  for (std::uint64_t k = 0; k < points; ++k) {
    do {
      if (!read_line(file, line, kMostTextLine)) ends_early(k, points);
    } while (line.find_first_not_of(" \t") == std::string::npos);
    const char* at = line.data();
    const char* const end = at + line.size();
    for (double& number : numbers) {
      while (at != end && (*at == ' ' || *at == '\t')) ++at;
      const auto [next, error] = std::from_chars(at, end, number);
      if (error != std::errc()) refuse("point " + std::to_string(k + 1) + " is '" + line.substr(0, 60) + "'");
      at = next;
    }
    listener.point(record.from_numbers(numbers));
  }
}

void read_binary(std::istream& file, const PointRecord& record, std::uint64_t points, bool swapped,
                 const CloudListener& listener) {
  std::vector<char> bytes(record.bytes());
  for (std::uint64_t k = 0; k < points; ++k) {
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) ends_early(k, points);
    listener.point(record.from_bytes(bytes.data(), swapped));
  }
}

NumberType ply_type(const std::string& name) {
  static const std::map<std::string, NumberType> types{
      {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUint8},
      {"uint8", NumberType::kUint8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
      {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},   {"int", NumberType::kInt32},
      {"int32", NumberType::kInt32},    {"uint", NumberType::kUint32},     {"uint32", NumberType::kUint32},
      {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64},
      {"float64", NumberType::kFloat64}};
  const auto found = types.find(name);
  if (found == types.end()) refuse("found '" + name + "' for a property's type");
  return found->second;
}

constexpr char kPlaceOnSite[] = "site_from_cloud";
constexpr double kFarthestSite_m = 1e7;

/// A header's `comment site_from_cloud X Y Z QX QY QZ QW`.
Pose read_place(const std::vector<std::string>& words) {
  std::array<double, 7> v{};
  if (words.size() != v.size() + 2) refuse("site_from_cloud has not seven numbers");
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::string& word = words[i + 2];
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v[i]);
    if (error != std::errc() || end != word.data() + word.size() || !(std::abs(v[i]) <= kFarthestSite_m)) {
      refuse("found '" + word + "' in site_from_cloud");
    }
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) refuse("the quaternion of site_from_cloud is not of length one");
  return {rotation.normalized(), {v[0], v[1], v[2]}};
}

void read_ply(std::istream& file, const CloudListener& listener) {
  std::string format;
  std::string element;
  std::optional<std::uint64_t> points;
  std::vector<RecordField> fields;
  CloudHeader header;
  for_each_header_line(file, "end_header", [&](const std::vector<std::string>& words) {
    if (words.front() == "format" && words.size() >= 2) format = words[1];
    if (words.front() == "comment" && words.size() >= 2 && words[1] == kPlaceOnSite) {
      header.site_from_cloud = read_place(words);
    }
    if (words.front() == "element" && words.size() == 3) {
      element = words[1];
      if (element == "vertex") points = count_from(words[2]);
      if (!points && count_from(words[2]) > 0) refuse("element '" + element + "' stands before vertex");
    }
    if (words.front() != "property" || element != "vertex") return;
    if (words.size() != 3) refuse("a vertex has a property that is no single number");
    fields.push_back({words[2], ply_type(words[1]), 1});
  });
  if (!points) refuse("it has no element vertex");
  const PointRecord record(fields);
  header.has_normals = record.has_normals();
  listener.header(header);
  if (format == "ascii") return read_text(file, record, *points, listener);
  if (format != "binary_little_endian" && format != "binary_big_endian") {
    refuse("found format '" + format + "'; allowed are ascii, binary_little_endian and binary_big_endian");
  }
  read_binary(file, record, *points, format == "binary_big_endian", listener);
}

NumberType pcd_type(const std::string& type, const std::string& size) {
  static const std::map<std::string, NumberType> types{{"I1", NumberType::kInt8},    {"U1", NumberType::kUint8},
                                                       {"I2", NumberType::kInt16},   {"U2", NumberType::kUint16},
                                                       {"I4", NumberType::kInt32},   {"U4", NumberType::kUint32},
                                                       {"I8", NumberType::kInt64},   {"U8", NumberType::kUint64},
                                                       {"F4", NumberType::kFloat32}, {"F8", NumberType::kFloat64}};
  const auto found = types.find(type + size);
  if (found == types.end()) refuse("found a field of TYPE " + type + " and SIZE " + size);
  return found->second;
}

std::uint32_t read_size(std::istream& file) {
  std::array<unsigned char, 4> bytes{};
  if (!file.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) refuse("it ends before its points");
  return bytes[0] | (std::uint32_t{bytes[1]} << 8) | (std::uint32_t{bytes[2]} << 16) | (std::uint32_t{bytes[3]} << 24);
}

/// Both sizes stand in the file; neither is believed beyond what the points need and the file holds.
void read_compressed(std::istream& file, const PointRecord& record, std::uint64_t points,
                     const CloudListener& listener) {
  const std::uint32_t packed = read_size(file);
  const std::uint32_t plain = read_size(file);
  if (points > kMostCompressed_bytes / record.bytes() || packed > kMostCompressed_bytes) {
    refuse("its points are more than 1 GB; write it as DATA binary, which is read point by point");
  }
  if (plain != points * record.bytes()) refuse("its compressed points have another size than its header says");
  const auto start = file.tellg();
  file.seekg(0, std::ios::end);
  if (file.tellg() - start < static_cast<std::streamoff>(packed)) refuse("it ends within its compressed points");
  file.seekg(start);
  std::string data(packed, '\0');
  file.read(data.data(), static_cast<std::streamsize>(packed));
  std::string columns(plain, '\0');
  if (pcl::lzfDecompress(data.data(), packed, columns.data(), plain) != plain) {
    refuse("its compressed points are damaged");
  }
  for (std::uint64_t k = 0; k < points; ++k) listener.point(record.from_columns(columns.data(), points, k));
}

void read_pcd(std::istream& file, const CloudListener& listener) {
  std::map<std::string, std::vector<std::string>> header;
  for_each_header_line(file, "DATA", [&](const std::vector<std::string>& words) {
    if (words.front()[0] != '#') header[words.front()] = {words.begin() + 1, words.end()};
  });
  const std::vector<std::string>& names = header["FIELDS"];
  const std::vector<std::string>& sizes = header["SIZE"];
  const std::vector<std::string>& types = header["TYPE"];
  std::vector<std::string>& counts = header["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (sizes.size() != names.size() || types.size() != names.size() || counts.size() != names.size()) {
    refuse("FIELDS, SIZE, TYPE and COUNT do not go together");
  }
  std::vector<RecordField> fields;
  for (std::size_t i = 0; i < names.size(); ++i) {
    fields.push_back({names[i], pcd_type(types[i], sizes[i]), count_from(counts[i])});
  }
  const PointRecord record(fields);
  if (header["POINTS"].size() != 1 || header["DATA"].size() != 1) refuse("POINTS or DATA is missing");
  const std::uint64_t points = count_from(header["POINTS"].front());
  const std::string& data = header["DATA"].front();
  listener.header({record.has_normals(), std::nullopt});
  if (data == "ascii") return read_text(file, record, points, listener);
  if (data == "binary") return read_binary(file, record, points, /*swapped=*/false, listener);
  if (data == "binary_compressed") return read_compressed(file, record, points, listener);
  refuse("found DATA '" + data + "'; allowed are ascii, binary and binary_compressed");
}

void read_any(const fs::path& path, const CloudListener& listener) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  if (!file || fs::is_directory(path, error)) refuse("cannot be read");
  const bool is_ply = file.get() == 'p' && file.get() == 'l' && file.get() == 'y';
  file.clear();
  file.seekg(0);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (is_ply) return read_ply(file, listener);
  if (extension == ".pcd") return read_pcd(file, listener);
  refuse("neither PLY nor PCD; allowed are files that begin with 'ply' or are named .pcd");
}

}  // namespace

void read_point_cloud(const fs::path& path, const CloudListener& listener) {
  try {
    read_any(path, listener);
  } catch (const std::invalid_argument& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

SitedMap read_prior_map(const fs::path& path) {
  std::optional<PriorMapBuilder> builder;
  std::optional<Pose> site_from_map;
  read_point_cloud(path, {[&](const CloudHeader& header) {
                            builder.emplace(header.has_normals);
                            site_from_map = header.site_from_cloud;
                          },
                          [&](const CloudPoint& p) { builder->add(p.position, p.normal, p.intensity); }});
  try {
    return {builder->build(), site_from_map};
  } catch (const std::invalid_argument& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

void write_place_on_site(const fs::path& ply, const Pose& site_from_cloud) {
  const Eigen::Vector3d& t = site_from_cloud.translation;
  const Eigen::Vector4d& q = site_from_cloud.rotation.coeffs();
  std::string comment = std::string("comment ") + kPlaceOnSite;
  for (const double number : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) append_exact(comment += ' ', number);
  const fs::path before = ply.string() + ".before";
  fs::rename(ply, before);
  {
    std::ifstream from(before, std::ios::binary);
    std::ofstream to(ply, std::ios::binary);
    std::string line;
    for (int k = 0; k < 2 && std::getline(from, line); ++k) to << line << '\n';  // "ply" and its format
    to << comment << '\n' << from.rdbuf();
    if (!from || !to.flush()) throw std::runtime_error(ply.string() + ": cannot be written");
  }
  fs::remove(before);
}

}  // namespace plumbline
