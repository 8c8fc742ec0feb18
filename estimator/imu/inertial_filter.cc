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

/// R = exp(a) R^, p = exp(a) p^ + b as a transform on the left.
Pose exp_left(const Vector6d& error) { return {exp_so3(error.head<3>()), error.tail<3>()}; }

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
  const double known = std::max(0.0, bias_variance - squared(start.tilt_sigma * kStandardGravity));
  covariance_.block<3, 3>(kAccelBias, kAccelBias) -= known * up_in_body * up_in_body.transpose();
  // What the gyro bias is wrong by has turned the heading ever since the first sample, about where the body is now.
  Eigen::Matrix<double, 9, 3> moving_from_bias;
  moving_from_bias.topRows<3>() = world_from_body * start.d_attitude_d_gyro_bias;
  moving_from_bias.middleRows<3>(kPosition) = skew(state_.world_from_body.translation) * moving_from_bias.topRows<3>();
  moving_from_bias.middleRows<3>(kVelocity) = skew(state_.velocity_in_world) * moving_from_bias.topRows<3>();
  covariance_.block<9, 3>(0, kGyroBias) = moving_from_bias * start.gyro_bias_covariance;
  covariance_.block<3, 9>(kGyroBias, 0) = covariance_.block<9, 3>(0, kGyroBias).transpose();
  covariance_.topLeftCorner<9, 9>() += moving_from_bias * start.gyro_bias_covariance * moving_from_bias.transpose();
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

  // Transition of the error state without what rests in the world: map and past poses.
  constexpr int kMoving = kMap;
  constexpr int kResting = kSize - kMoving;
  // An attitude's error turns velocity and position about the origin.
  Eigen::Matrix<double, 9, 3> turned;
  turned.topRows<3>().setIdentity();
  turned.middleRows<3>(kPosition) = skew(next.world_from_body.translation);
  turned.middleRows<3>(kVelocity) = skew(next.velocity_in_world);
  Eigen::Matrix<double, kMoving, kMoving> f = Eigen::Matrix<double, kMoving, kMoving>::Identity();
  const Eigen::Matrix3d d_velocity_d_attitude = h * skew(state_.gravity_in_world);
  f.block<3, 3>(kVelocity, kAttitude) = d_velocity_d_attitude;
  f.block<3, 3>(kVelocity, kAccelBias) = -h * r;
  f.block<3, 2>(kVelocity, kGravity) = h * Eigen::Matrix3d::Identity().leftCols<2>();
  f.block<3, 3>(kPosition, kAttitude) = 0.5 * h * d_velocity_d_attitude;
  f.block<3, 3>(kPosition, kVelocity) = h * Eigen::Matrix3d::Identity();
  f.block<3, 3>(kPosition, kAccelBias) = -0.5 * h * h * r;
  f.block<3, 2>(kPosition, kGravity) = 0.5 * h * h * Eigen::Matrix3d::Identity().leftCols<2>();
  f.block<9, 3>(0, kGyroBias) =
      turned * (-h * next.world_from_body.rotation.toRotationMatrix() * right_jacobian_so3(h * rate));

  auto moving = covariance_.topLeftCorner<kMoving, kMoving>();
  moving = (f * moving * f.transpose()).eval();
  auto cross = covariance_.topRightCorner<kMoving, kResting>();
  cross = (f * cross).eval();
  covariance_.bottomLeftCorner<kResting, kMoving>() = cross.transpose();

  const double push = (r * force + state_.gravity_in_world).norm();
  const double misread_rate = kShapeError * rate.norm() + kPushedRate * push;
  const double turn_density = std::hypot(kDensityMargin * noise_.gyro_density, std::sqrt(kSwing_s) * misread_rate);
  moving.topLeftCorner<9, 9>() += squared(turn_density) * h * turned * turned.transpose();
  const auto add_noise = [&](int block, double density) {
    moving.block<3, 3>(block, block).diagonal().array() += squared(density) * h;
  };
  add_noise(kVelocity, std::hypot(kDensityMargin * noise_.accel_density, std::sqrt(kSwing_s) * kShapeError * push));
  add_noise(kGyroBias, noise_.gyro_random_walk);
  add_noise(kAccelBias, noise_.accel_random_walk);
  symmetrize();
  state_ = next;
}

Matrix6d InertialFilter::pose_covariance() const {
  const Matrix6d body_from_world = adjoint(state_.world_from_body.inverse());
  return body_from_world * covariance_.topLeftCorner<6, 6>() * body_from_world.transpose();
}

/// map_from_body = exp(map's error + body's error) of the estimate.
InertialFilter::Jacobian InertialFilter::map_jacobian() const {
  Jacobian j = Jacobian::Zero();
  j.leftCols<6>() = j.middleCols<6>(kMap) = adjoint(map_from_body().inverse());
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
  const Matrix6d map_from_errors = adjoint(map_from_body());
  covariance_.block<6, 6>(kMap, kMap) += map_from_errors * systematic * map_from_errors.transpose();
  symmetrize();
}

void InertialFilter::update_keyframe_motion(const SolveResult& solved, const Pose& predicted, double inflation) {
  Vector6d along = Vector6d::Zero();
  along.tail<3>() = kSharedDepthError * (solved.pose.rotation.conjugate() * solved.pose.translation);
  update(solved, predicted, motion_jacobian(kKeyframe), inflation, along * along.transpose());
}

/// clone_from_body = estimate exp(Ad(body_from_world) (body's error - clone's error)).
InertialFilter::Jacobian InertialFilter::motion_jacobian(int clone) const {
  Jacobian j = Jacobian::Zero();
  j.leftCols<6>() = adjoint(state_.world_from_body.inverse());
  j.middleCols<6>(clone) = -j.leftCols<6>();
  return j;
}

Matrix6d InertialFilter::keyframe_motion_covariance() const {
  const Jacobian j = motion_jacobian(kKeyframe);
  return j * covariance_ * j.transpose();
}

Matrix6d InertialFilter::past_motion_covariance() const {
  const Jacobian j = motion_jacobian(kPast);
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
  const Pose corrected_from_world = exp_left(correction.segment<6>(kAttitude));
  state_.world_from_body = corrected_from_world * state_.world_from_body;
  state_.velocity_in_world =
      corrected_from_world.rotation * state_.velocity_in_world + correction.segment<3>(kVelocity);
  state_.gyro_bias += correction.segment<3>(kGyroBias);
  state_.accel_bias += correction.segment<3>(kAccelBias);
  const Eigen::Vector2d lean = state_.gravity_in_world.head<2>() + correction.segment<2>(kGravity);
  const double down = std::sqrt(std::max(0.0, squared(kStandardGravity) - lean.squaredNorm()));
  state_.gravity_in_world << lean, -down;
  map_from_world_ = exp_left(correction.segment<6>(kAttitude) + correction.segment<6>(kMap)) * map_from_world_ *
                    corrected_from_world.inverse();
  world_from_keyframe_ = exp_left(correction.segment<6>(kKeyframe)) * world_from_keyframe_;
  world_from_past_ = exp_left(correction.segment<6>(kPast)) * world_from_past_;
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
