#include "tools/formats/kitti_calibration.h"

#include <Eigen/SVD>

#include "scenarios/input_error.h"
#include "sim/text_fields.h"
#include "tools/formats/number_text.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

constexpr std::size_t kMostKeys = 1000;
constexpr double kRotationTolerance = 0.01;

}  // namespace

std::map<std::string, std::vector<double>> read_kitti_keys(const std::filesystem::path& path) {
  std::map<std::string, std::vector<double>> keys;
  TextTable table(path);
  while (table.next()) {
    if (keys.size() == kMostKeys) table.reject("more than 1000 keys");
    std::string key(table.word(0));
    if (!key.empty() && key.back() == ':') key.pop_back();
    std::vector<double> values;
    for (std::size_t i = 1; i < table.size(); ++i) {
      const auto value = parse_number(table.word(i));
      if (!value) break;
      values.push_back(*value);
    }
    if (values.size() + 1 == table.size()) keys[key] = std::move(values);
  }
  return keys;
}

Pose kitti_pose(const std::vector<double>& rows, const std::string& where) {
  if (rows.size() != 12) {
    throw InputError(where + ": found " + std::to_string(rows.size()) + " numbers, expected the 12 of a 3 x 4 matrix");
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(rows.data());
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if (!matrix.allFinite() || nearest.determinant() < 0.0 || !((rotation - nearest).norm() < kRotationTolerance)) {
    throw InputError(where + ": found a matrix that is no rotation and translation");
  }
  return {Eigen::Quaterniond(nearest).normalized(), matrix.col(3)};
}

std::string kitti_pose_text(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!text.empty()) text += ' ';
      append_general(text, column < 3 ? rotation(row, column) : pose.translation[row], 17);
    }
  }
  return text;
}

}  // namespace plumbline
