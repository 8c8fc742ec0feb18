#include "estimator/imu/inertial_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"
#include "estimator/geometry/symmetric_eigen.h"
#include "estimator/imu/squared.h"

namespace plumbline {
namespace {

// Real units err by more than their white noise (scale, misalignment, aliasing of vibration).
constexpr double kDensityMargin = 1.5;
// Scale and misalignment make a unit misread what it measures by so much, a gyroscope also by what pushes it: figures
// of consumer and automotive MEMS. Between rest and motion these errors change, which a bias cannot follow; they last
// as long as a swing or a turn does.
constexpr double kShapeError = 2e-3;    // of the reading
constexpr double kPushedRate = 1.7e-4;  // [rad/s per m/s^2]
constexpr double kSwing_s = 0.2;
// Of an innovation's squared length in its own sigmas, a degree of freedom: sound solutions of either module stay below
// 2.1 (garage, tunnel), and six degrees of chance exceed 3.7 once in a thousand. What lies beyond is the solution's
// fault, shared by all its rows so that no row's residual shows it.
constexpr double kLargestInnovation = 3.7;
// Depths of one key-frame err by a factor that its features share, and with it the translation since: against the truth
// 0.3 % in the middle, with outliers of 2 to 15 % where the motion that placed the lidar's points was wrong.
constexpr double kSharedDepthError = 0.01;

/// Forced 6-DOF knows no conditioning: its solution replaces the prediction along every direction (thesis 5.7 with all
/// coefficients one). Directions below the middle of the spectrum are taken as sure as the middle.
Eigen::MatrixXd lifted_to_the_middle(const Eigen::MatrixXd& information) {
  const SymmetricEigen<Eigen::MatrixXd> eigen(information);
  const double middle = eigen.values[eigen.values.size() / 2];
  return eigen.vectors * eigen.values.cwiseMax(middle).asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

InertialFilter::InertialFilter(const InitialState& start, const ImuNoise& noise, bool remapping)
    : state_(start.state), noise_(noise), remapping_(remapping) {
  covariance_.block<3, 3>(kVelocity, kVelocity).diagonal().setConstant(squared(start.velocity_sigma));
  covariance_.block<3, 3>(kGyroBias, kGyroBias) = start.gyro_bias_covariance;
  // The world's z axis is where the mean force pointed. Where an accelerometer bias tilted it, gravity leans the other
  // way in that world: bias across gravity and gravity's lean are one unknown until the body turns.
  const double bias_variance = squared(noise.accel_turn_on_sigma);
  const Eigen::Matrix3d world_from_body = state_.world_from_body.rotation.toRotationMatrix();
  Eigen::Matrix<double, 2, 3> lean_from_bias = world_from_body.topRows<2>();
  covariance_.block<3, 3>(kAccelBias, kAccelBias).diagonal().setConstant(bias_variance);
  covariance_.block<2, 3>(kGravity, kAccelBias) = bias_variance * lean_from_bias;
  covariance_.block<3, 2>(kAccelBias, kGravity) = bias_variance * lean_from_bias.transpose();
  covariance_.block<2, 2>(kGravity, kGravity)
      .diagonal()
      .setConstant(bias_variance + squared(start.tilt_sigma * kStandardGravity));
  // The mean force's length also gave the bias along gravity.
  const Eigen::Vector3d up_in_body = world_from_body.transpose().col(2);
  // What the gyro bias is wrong by has turned the heading ever since the first sample.
  const Eigen::Matrix3d& attitude_from_bias = start.d_attitude_d_gyro_bias;
  covariance_.block<3, 3>(kAttitude, kGyroBias) = attitude_from_bias * start.gyro_bias_covariance;
  covariance_.block<3, 3>(kGyroBias, kAttitude) = covariance_.block<3, 3>(kAttitude, kGyroBias).transpose();
  covariance_.block<3, 3>(kAttitude, kAttitude) =
      attitude_from_bias * start.gyro_bias_covariance * attitude_from_bias.transpose();
  const double known = std::max(0.0, bias_variance - squared(start.tilt_sigma * kStandardGravity));
  covariance_.block<3, 3>(kAccelBias, kAccelBias) -= known * up_in_body * up_in_body.transpose();
  set_keyframe(state_.world_from_body);
  set_past();
}

void InertialFilter::predict(const InertialSegment& segment) {
  const double h = seconds_between(segment.start_ns, segment.end_ns);
  if (h <= 0.0) return;
  const Eigen::Vector3d rate = segment.rate - state_.gyro_bias;
  const Eigen::Vector3d force = segment.force - state_.accel_bias;
  const Eigen::Matrix3d r = state_.world_from_body.rotation.toRotationMatrix();
  const NavigationState next = mechanize(state_, segment);
  const Eigen::Matrix3d body_now_from_before =
      (next.world_from_body.rotation.conjugate() * state_.world_from_body.rotation).toRotationMatrix();

  // Transition of the error state without the poses that rest.
  constexpr int kMoving = kKeyframe;
  constexpr int kResting = kSize - kMoving;
  Eigen::Matrix<double, kMoving, kMoving> f = Eigen::Matrix<double, kMoving, kMoving>::Identity();
  f.block<3, 3>(kAttitude, kAttitude) = body_now_from_before;
  f.block<3, 3>(kAttitude, kGyroBias) = -h * right_jacobian_so3(h * rate);
  const Eigen::Matrix3d d_velocity_d_attitude = -h * r * skew(force);
  f.block<3, 3>(kVelocity, kAttitude) = d_velocity_d_attitude;
  f.block<3, 3>(kVelocity, kAccelBias) = -h * r;
  f.block<3, 2>(kVelocity, kGravity) = h * Eigen::Matrix3d::Identity().leftCols<2>();
  const Eigen::Matrix3d body_now_from_world = next.world_from_body.rotation.conjugate().toRotationMatrix();
  f.block<3, 3>(kPosition, kPosition) = body_now_from_before;
  f.block<3, 3>(kPosition, kAttitude) = 0.5 * h * body_now_from_world * d_velocity_d_attitude;
  f.block<3, 3>(kPosition, kVelocity) = h * body_now_from_world;
  f.block<3, 3>(kPosition, kAccelBias) = -0.5 * h * h * body_now_from_world * r;
  f.block<3, 2>(kPosition, kGravity) = 0.5 * h * h * body_now_from_world.leftCols<2>();

  // The map rests in the world, and so its offset moves as seen from the body.
  const Matrix6d carry = adjoint(next.world_from_body.inverse() * state_.world_from_body);
  f.block<6, 6>(kMap, kMap) = carry;

  auto moving = covariance_.topLeftCorner<kMoving, kMoving>();
  moving = (f * moving * f.transpose()).eval();
  auto cross = covariance_.topRightCorner<kMoving, kResting>();
  cross = (f * cross).eval();
  covariance_.bottomLeftCorner<kResting, kMoving>() = cross.transpose();

  const auto add_noise = [&](int block, double density) {
    moving.block<3, 3>(block, block).diagonal().array() += squared(density) * h;
  };
  const double push = (r * force + state_.gravity_in_world).norm();
  const double misread_rate = kShapeError * rate.norm() + kPushedRate * push;
  add_noise(kAttitude, std::hypot(kDensityMargin * noise_.gyro_density, std::sqrt(kSwing_s) * misread_rate));
  add_noise(kVelocity, std::hypot(kDensityMargin * noise_.accel_density, std::sqrt(kSwing_s) * kShapeError * push));
  add_noise(kGyroBias, noise_.gyro_random_walk);
  add_noise(kAccelBias, noise_.accel_random_walk);
  symmetrize();
  state_ = next;
  map_offset_ = carry * map_offset_;
}

InertialFilter::Jacobian InertialFilter::map_jacobian() {
  Jacobian j = Jacobian::Zero();
  j.leftCols<6>().setIdentity();
  j.middleCols<6>(kMap).setIdentity();
  return j;
}

Matrix6d InertialFilter::map_from_body_covariance() const {
  const Jacobian j = map_jacobian();
  return j * covariance_ * j.transpose();
}

void InertialFilter::update_pose(const SolveResult& solved, const Pose& predicted, double inflation) {
  update(solved, predicted, map_jacobian(), inflation, Matrix6d::Zero());
}

/// New content has the present pose's error, which is that of the state with the other sign.
void InertialFilter::renew_map(double share, const Matrix6d& systematic) {
  Covariance renewed = Covariance::Identity();
  renewed.block<6, 6>(kMap, kMap) *= 1.0 - share;
  renewed.block<6, 6>(kMap, 0).diagonal().setConstant(-share);
  covariance_ = (renewed * covariance_ * renewed.transpose()).eval();
  covariance_.block<6, 6>(kMap, kMap) += systematic;
  symmetrize();
}

void InertialFilter::update_keyframe_motion(const SolveResult& solved, const Pose& predicted, double inflation) {
  Vector6d along = Vector6d::Zero();
  along.tail<3>() = kSharedDepthError * (solved.pose.rotation.conjugate() * solved.pose.translation);
  update(solved, predicted, motion_jacobian(world_from_keyframe_, kKeyframe), inflation, along * along.transpose());
}

/// clone_from_body retracted by (-Ad(body_from_clone) clone's error + body error).
InertialFilter::Jacobian InertialFilter::motion_jacobian(const Pose& world_from_clone, int clone) const {
  Jacobian j = Jacobian::Zero();
  j.leftCols<6>().setIdentity();
  j.middleCols<6>(clone) = -adjoint(state_.world_from_body.inverse() * world_from_clone);
  return j;
}

Matrix6d InertialFilter::keyframe_motion_covariance() const {
  const Jacobian j = motion_jacobian(world_from_keyframe_, kKeyframe);
  return j * covariance_ * j.transpose();
}

Matrix6d InertialFilter::past_motion_covariance() const {
  const Jacobian j = motion_jacobian(world_from_past_, kPast);
  return j * covariance_ * j.transpose();
}

void InertialFilter::update(const SolveResult& solved, const Pose& predicted, const Jacobian& d_pose_d_error,
                            double inflation, const Matrix6d& shared) {
  const int n = solved.spectrum.well_conditioned;
  if (n == 0) return;
  // The data's own solution within the well-conditioned directions, as a perturbation of the solved pose.
  const Eigen::MatrixXd directions = solved.spectrum.eigenvectors.rightCols(n);
  const Eigen::MatrixXd information = directions.transpose() * solved.information * directions;
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return;
  const Eigen::VectorXd measured = -factor.solve(directions.transpose() * solved.gradient);
  const Eigen::MatrixXd believed = remapping_ ? information : lifted_to_the_middle(information);
  Eigen::MatrixXd noise = inflation * believed.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  noise += directions.transpose() * shared * directions;
  const Eigen::VectorXd innovation = measured - directions.transpose() * solved.pose.local(predicted);

  const Eigen::MatrixXd h = directions.transpose() * d_pose_d_error;
  const Eigen::MatrixXd covariance_ht = covariance_ * h.transpose();
  const Eigen::MatrixXd foreseen = h * covariance_ht;
  Eigen::LDLT<Eigen::MatrixXd> expected(foreseen + noise);
  const double surprise = innovation.dot(expected.solve(innovation)) / n;
  if (remapping_ && surprise > kLargestInnovation) {
    noise *= surprise / kLargestInnovation;
    expected.compute(foreseen + noise);
  }
  const Eigen::MatrixXd gain = expected.solve(covariance_ht.transpose()).transpose();
  const ErrorState correction = gain * innovation;
  if (!correction.allFinite()) return;
  // Joseph's form keeps the covariance symmetric and positive.
  const Covariance kept = Covariance::Identity() - gain * h;
  covariance_ = (kept * covariance_ * kept.transpose() + gain * noise * gain.transpose()).eval();
  symmetrize();
  apply(correction);
}

/// Rounding's antisymmetric part would grow with the absolute pose's covariance and swamp the key-frame motion's, which
/// is a small difference of large blocks.
void InertialFilter::symmetrize() { covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval(); }

void InertialFilter::apply(const ErrorState& correction) {
  state_.world_from_body = state_.world_from_body.retract(correction.segment<6>(kAttitude));
  state_.velocity_in_world += correction.segment<3>(kVelocity);
  state_.gyro_bias += correction.segment<3>(kGyroBias);
  state_.accel_bias += correction.segment<3>(kAccelBias);
  const Eigen::Vector2d lean = state_.gravity_in_world.head<2>() + correction.segment<2>(kGravity);
  const double down = std::sqrt(std::max(0.0, squared(kStandardGravity) - lean.squaredNorm()));
  state_.gravity_in_world << lean, -down;
  map_offset_ += correction.segment<6>(kMap);
  world_from_keyframe_ = world_from_keyframe_.retract(correction.segment<6>(kKeyframe));
  world_from_past_ = world_from_past_.retract(correction.segment<6>(kPast));
}

void InertialFilter::set_keyframe(const Pose& world_from_body) {
  world_from_keyframe_ = world_from_body;
  clone_pose(kKeyframe);
}

void InertialFilter::set_past() {
  world_from_past_ = state_.world_from_body;
  clone_pose(kPast);
}

void InertialFilter::clone_pose(int clone) {
  covariance_.middleCols<6>(clone) = covariance_.leftCols<6>().eval();
  covariance_.middleRows<6>(clone) = covariance_.topRows<6>().eval();
}

}  // namespace plumbline
