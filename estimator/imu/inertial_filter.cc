#include "estimator/imu/inertial_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
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

constexpr std::array kPoses = {InertialFilter::kWorld, InertialFilter::kMap, InertialFilter::kKeyframe,
                               InertialFilter::kPast};

/// What one step of the inertial prediction does to errors, block by block: most of its matrix is zero.
struct Transition {
  Eigen::Matrix3d now_from_before;
  Eigen::Matrix3d turn_of_bias;      ///< how far a gyro bias turns the body over the step
  Eigen::Vector3d step_in_body;      ///< the translation, seen from the body before
  Eigen::Vector3d velocity_in_body;  ///< now
  Eigen::Vector3d gravity_in_body;   ///< now
  double h = 0.0;                    ///< [s]

  /// The transition matrix times x.
  InertialFilter::Covariance operator()(const InertialFilter::Covariance& x) const {
    using Filter = InertialFilter;
    InertialFilter::Covariance y = x;
    const auto turned = (turn_of_bias * x.middleRows<3>(Filter::kGyroBias)).eval();
    const auto pushed = (x.middleRows<3>(Filter::kGravity) - x.middleRows<3>(Filter::kAccelBias)).eval();
    const auto moved = (h * x.middleRows<3>(Filter::kVelocity) + 0.5 * h * h * pushed).eval();
    for (const int pose : kPoses) {
      const auto attitude = x.middleRows<3>(pose);
      y.middleRows<3>(pose) = now_from_before * attitude - turned;
      y.middleRows<3>(pose + 3) = now_from_before * (x.middleRows<3>(pose + 3) + moved - skew(step_in_body) * attitude);
    }
    y.middleRows<3>(Filter::kVelocity) =
        now_from_before * (x.middleRows<3>(Filter::kVelocity) + h * pushed) - skew(velocity_in_body) * turned;
    y.middleRows<3>(Filter::kGravity) =
        now_from_before * x.middleRows<3>(Filter::kGravity) - skew(gravity_in_body) * turned;
    return y;
  }
};

}  // namespace

InertialFilter::InertialFilter(const InitialState& start, const ImuNoise& noise, bool remapping)
    : state_(start.state), map_from_body_(start.state.world_from_body), noise_(noise), remapping_(remapping) {
  const Eigen::Matrix3d body_from_world = state_.world_from_body.rotation.conjugate().toRotationMatrix();
  covariance_.block<3, 3>(kVelocity, kVelocity).diagonal().setConstant(squared(start.velocity_sigma));
  // The world's z axis is where the mean force pointed. Where an accelerometer bias tilted it, gravity leans the other
  // way in that world: bias across gravity and gravity's lean are one unknown until the body turns. Along gravity the
  // force's length gave the bias.
  const double bias_variance = squared(noise.accel_turn_on_sigma);
  const double tilt_variance = squared(start.tilt_sigma * kStandardGravity);
  const Eigen::Vector3d up = body_from_world.col(2);
  const Eigen::Matrix3d along = up * up.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
  covariance_.block<3, 3>(kAccelBias, kAccelBias) =
      bias_variance * across + std::min(bias_variance, tilt_variance) * along;
  covariance_.block<3, 3>(kGravity, kAccelBias) = bias_variance * across;
  covariance_.block<3, 3>(kAccelBias, kGravity) = bias_variance * across;
  covariance_.block<3, 3>(kGravity, kGravity) = (bias_variance + tilt_variance) * across;
  // What the gyro bias is wrong by has turned the body ever since the first sample, and with it what it sees.
  Covariance from_bias = Covariance::Identity();
  from_bias.block<3, 3>(kWorld, kGyroBias) = start.d_attitude_d_gyro_bias;
  from_bias.block<3, 3>(kVelocity, kGyroBias) =
      skew(body_from_world * state_.velocity_in_world) * start.d_attitude_d_gyro_bias;
  from_bias.block<3, 3>(kGravity, kGyroBias) =
      skew(body_from_world * state_.gravity_in_world) * start.d_attitude_d_gyro_bias;
  covariance_.block<3, 3>(kGyroBias, kGyroBias) = start.gyro_bias_covariance;
  covariance_ = (from_bias * covariance_ * from_bias.transpose()).eval();
}

void InertialFilter::predict(const InertialSegment& segment) {
  const double h = seconds_between(segment.start_ns, segment.end_ns);
  if (h <= 0.0) return;
  const Eigen::Vector3d rate = segment.rate - state_.gyro_bias;
  const Eigen::Vector3d force = segment.force - state_.accel_bias;
  const NavigationState next = mechanize(state_, segment);
  const Eigen::Quaterniond body_from_world = next.world_from_body.rotation.conjugate();
  const Pose before_from_now = state_.world_from_body.inverse() * next.world_from_body;

  Transition transition;
  transition.h = h;
  transition.now_from_before = before_from_now.rotation.conjugate().toRotationMatrix();
  transition.turn_of_bias = h * right_jacobian_so3(h * rate);
  transition.step_in_body = before_from_now.translation;
  transition.velocity_in_body = body_from_world * next.velocity_in_world;
  transition.gravity_in_body = body_from_world * next.gravity_in_world;
  covariance_ = transition(transition(covariance_).transpose());

  const double push = (state_.world_from_body.rotation * force + state_.gravity_in_world).norm();
  const double misread_rate = kShapeError * rate.norm() + kPushedRate * push;
  const double turn_density = std::hypot(kDensityMargin * noise_.gyro_density, std::sqrt(kSwing_s) * misread_rate);
  Eigen::Matrix<double, kSize, 3> turned = Eigen::Matrix<double, kSize, 3>::Zero();
  for (const int pose : kPoses) turned.middleRows<3>(pose).setIdentity();
  turned.middleRows<3>(kVelocity) = skew(transition.velocity_in_body);
  turned.middleRows<3>(kGravity) = skew(transition.gravity_in_body);
  covariance_.noalias() += squared(turn_density) * h * turned * turned.transpose();
  const auto add_noise = [&](int block, double density) {
    covariance_.diagonal().segment<3>(block).array() += squared(density) * h;
  };
  add_noise(kVelocity, std::hypot(kDensityMargin * noise_.accel_density, std::sqrt(kSwing_s) * kShapeError * push));
  add_noise(kGyroBias, noise_.gyro_random_walk);
  add_noise(kAccelBias, noise_.accel_random_walk);
  symmetrize();
  map_revision_ = (std::exp(-h / kRevisionMemory_s) * (adjoint(before_from_now.inverse()) * map_revision_)).eval();
  map_from_body_ = map_from_body_ * before_from_now;
  keyframe_from_body_ = keyframe_from_body_ * before_from_now;
  state_ = next;
}

void InertialFilter::update_pose(const SolveResult& solved, const Pose& predicted, double inflation) {
  update(solved, predicted, kMap, inflation, Matrix6d::Zero());
}

/// New content is put where the body is thought to be in the map: in it, the body's place is certain.
void InertialFilter::renew_map(double share, const Matrix6d& systematic) {
  covariance_.middleRows<6>(kMap) *= 1.0 - share;
  covariance_.middleCols<6>(kMap) *= 1.0 - share;
  covariance_.block<6, 6>(kMap, kMap) += systematic;
  symmetrize();
}

void InertialFilter::update_keyframe_motion(const SolveResult& solved, const Pose& predicted, double inflation) {
  Vector6d along = Vector6d::Zero();
  along.tail<3>() = kSharedDepthError * (solved.pose.rotation.conjugate() * solved.pose.translation);
  update(solved, predicted, kKeyframe, inflation, along * along.transpose());
}

void InertialFilter::update(const SolveResult& solved, const Pose& predicted, int pose, double inflation,
                            const Matrix6d& shared) {
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

  const Eigen::MatrixXd covariance_ht = covariance_.middleCols<6>(pose) * directions;
  const Eigen::MatrixXd foreseen = directions.transpose() * covariance_ht.middleRows<6>(pose);
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
  Covariance kept = Covariance::Identity();
  kept.middleCols<6>(pose) -= gain * directions.transpose();
  covariance_ = (kept * covariance_ * kept.transpose() + gain * noise * gain.transpose()).eval();
  symmetrize();
  apply(correction);
}

void InertialFilter::symmetrize() { covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval(); }

void InertialFilter::apply(const ErrorState& correction) {
  // Where the map around the body lies in the world is world_from_body times the inverse of map_from_body.
  map_revision_ += correction.segment<6>(kWorld) - correction.segment<6>(kMap);
  const Eigen::Quaterniond body_from_world = state_.world_from_body.rotation.conjugate();
  const Eigen::Vector3d velocity = body_from_world * state_.velocity_in_world + correction.segment<3>(kVelocity);
  const Eigen::Vector3d gravity = body_from_world * state_.gravity_in_world + correction.segment<3>(kGravity);
  state_.world_from_body = state_.world_from_body.retract(correction.segment<6>(kWorld));
  state_.velocity_in_world = state_.world_from_body.rotation * velocity;
  state_.gravity_in_world = kStandardGravity * (state_.world_from_body.rotation * gravity).normalized();
  state_.gyro_bias += correction.segment<3>(kGyroBias);
  state_.accel_bias += correction.segment<3>(kAccelBias);
  map_from_body_ = map_from_body_.retract(correction.segment<6>(kMap));
  keyframe_from_body_ = keyframe_from_body_.retract(correction.segment<6>(kKeyframe));
}

void InertialFilter::set_keyframe(const Pose& world_from_keyframe) {
  keyframe_from_body_ = world_from_keyframe.inverse() * state_.world_from_body;
  start_frame(kKeyframe);
}

void InertialFilter::set_past() { start_frame(kPast); }

void InertialFilter::start_frame(int pose) {
  covariance_.middleRows<6>(pose).setZero();
  covariance_.middleCols<6>(pose).setZero();
}

}  // namespace plumbline
