#include "tools/formats/point_record.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

namespace plumbline {
namespace {

template <typename Number>
double read_as(const char* from, bool swapped) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(Number));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  Number number;
  std::memcpy(&number, bytes.data(), sizeof(Number));
  return static_cast<double>(number);
}

double read_number(NumberType type, const char* from, bool swapped) {
  switch (type) {
    case NumberType::kInt8:
      return read_as<std::int8_t>(from, swapped);
    case NumberType::kUint8:
      return read_as<std::uint8_t>(from, swapped);
    case NumberType::kInt16:
      return read_as<std::int16_t>(from, swapped);
    case NumberType::kUint16:
      return read_as<std::uint16_t>(from, swapped);
    case NumberType::kInt32:
      return read_as<std::int32_t>(from, swapped);
    case NumberType::kUint32:
      return read_as<std::uint32_t>(from, swapped);
    case NumberType::kInt64:
      return read_as<std::int64_t>(from, swapped);
    case NumberType::kUint64:
      return read_as<std::uint64_t>(from, swapped);
    case NumberType::kFloat32:
      return read_as<float>(from, swapped);
    case NumberType::kFloat64:
      return read_as<double>(from, swapped);
  }
  return 0.0;
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::kInt8:
    case NumberType::kUint8:
      return 1;
    case NumberType::kInt16:
    case NumberType::kUint16:
      return 2;
    case NumberType::kInt64:
    case NumberType::kUint64:
    case NumberType::kFloat64:
      return 8;
    default:
      return 4;
  }
}

PointRecord::PointRecord(const std::vector<RecordField>& fields) {
  const std::map<std::string, Role> roles{{"x", kX},
                                          {"y", kY},
                                          {"z", kZ},
                                          {"normal_x", kNormalX},
                                          {"normal_y", kNormalY},
                                          {"normal_z", kNormalZ},
                                          {"nx", kNormalX},
                                          {"ny", kNormalY},
                                          {"nz", kNormalZ},
                                          {"intensity", kIntensity}};
  for (const RecordField& field : fields) {
    const auto role = roles.find(field.name);
    if (role != roles.end() && field.count == 1) used_[role->second] = Place{bytes_, numbers_, field.type};
    if (field.count > kMostBytes) throw std::invalid_argument("field '" + field.name + "' is too long");
    bytes_ += field.count * size_of(field.type);
    numbers_ += field.count;
    if (bytes_ > kMostBytes) throw std::invalid_argument("its points are larger than 65536 bytes each");
  }
  if (!used_[kX] || !used_[kY] || !used_[kZ]) throw std::invalid_argument("its points have no x, y and z");
}

template <typename Read>
CloudPoint PointRecord::assemble(Read read) const {
  CloudPoint point;
  point.position = {read(*used_[kX]), read(*used_[kY]), read(*used_[kZ])};
  if (has_normals()) {
    point.normal =
        Eigen::Vector3d(read(*used_[kNormalX]), read(*used_[kNormalY]), read(*used_[kNormalZ])).cast<float>();
  }
  if (used_[kIntensity]) point.intensity = static_cast<float>(read(*used_[kIntensity]));
  return point;
}

CloudPoint PointRecord::from_bytes(const char* record, bool swapped) const {
  return assemble([&](const Place& place) { return read_number(place.type, record + place.offset, swapped); });
}

CloudPoint PointRecord::from_columns(const char* data, std::size_t points, std::size_t index) const {
  return assemble([&](const Place& place) {
    return read_number(place.type, data + place.offset * points + index * size_of(place.type), false);
  });
}

CloudPoint PointRecord::from_numbers(const std::vector<double>& numbers) const {
  return assemble([&](const Place& place) { return numbers[place.index]; });
}

}  // namespace plumbline
