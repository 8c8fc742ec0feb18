#include "estimator/lidar/sweep_bends.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/lidar/direction_sampling.h"

namespace plumbline {
namespace {

constexpr double kKnotStep_s = 0.125;  // a walker bends by 1.5 mm and 0.04 degrees in between
constexpr int kBendRounds = 4;         // of finding what the features lie on
constexpr int kBendBudget = 1500;      // features of a class
// Rows share errors that whitening does not know, the map's; as in matching a whole sweep.
constexpr double kBendInflation = 25.0;
constexpr double kSweepsRemembered = 8.0;
// Before anything is learnt, as [rad^2/s^3] and [m^2/s^3], and the least.
constexpr double kFirstDensity = 0.1;
constexpr double kLeastDensity = 1e-6;
// Of the first knots: a rate of 1.6 rad/s, a velocity of 8 m/s, and where matching began.
constexpr std::array<double, 4> kFirstSigmas{0.2, 1.0, 0.02, 0.1};
constexpr double kNoTurn = 1e12;  // information that keeps attitude as it was read

constexpr double kWindingsRemembered = 10.0;
constexpr int kLeastWindings = 4;
constexpr double kUnwoundShare = 0.5;
constexpr double kClearly = 2.0;  // variances of the mean

/// The corrections at all knots, right perturbations; the first is the last but one knot of the sweep before.
class Knots {
 public:
  Knots(const Pose& first, const PoseTrack& steady, std::int64_t begin_ns, std::int64_t end_ns)
      : first_(first),
        steady_(steady),
        begin_ns_(begin_ns),
        end_ns_(end_ns),
        intervals_(std::max(2, static_cast<int>(std::lround(seconds_between(begin_ns, end_ns) / kKnotStep_s)))),
        step_s_(seconds_between(begin_ns, end_ns) / intervals_),
        corrections_(Eigen::VectorXd::Zero(6 * count())) {}

  int count() const { return intervals_ + 2; }
  int intervals() const { return intervals_; }
  double step_s() const { return step_s_; }
  double duration_s() const { return intervals_ * step_s_; }
  std::int64_t stamp_ns(double offset_s) const {
    return std::clamp(begin_ns_ + static_cast<std::int64_t>(1e9 * offset_s), begin_ns_, end_ns_);
  }
  const Eigen::VectorXd& corrections() const { return corrections_; }
  void correct(const Eigen::VectorXd& by) { corrections_ += by; }
  /// From the sweep's middle on, and back.
  void turn_about_middle(const Vector6d& over_sweep) {
    for (int k = 0; k <= intervals_; ++k) {
      corrections_.segment<6>(6 * k + 6) += (static_cast<double>(k) / intervals_ - 0.5) * over_sweep;
    }
  }

  /// The knot before a time within the sweep, and its share.
  std::pair<int, double> place(double offset_s) const {
    const double steps = std::clamp(offset_s / step_s_, 0.0, static_cast<double>(intervals_));
    const int before = std::min(static_cast<int>(steps), intervals_ - 1);
    return {before + 1, 1.0 - (steps - before)};
  }
  Pose at(double offset_s) const {
    const auto [k, share] = place(offset_s);
    return steady_.at(stamp_ns(offset_s))
        .retract(share * corrections_.segment<6>(6 * k) + (1.0 - share) * corrections_.segment<6>(6 * k + 6));
  }
  Pose knot(int k) const { return k == 0 ? first_.retract(corrections_.head<6>()) : at(step_s_ * (k - 1)); }
  Vector6d acceleration(int k) const {  // at a knot, times step_s squared
    const Pose here = knot(k);
    return here.local(knot(k - 1)) + here.local(knot(k + 1));
  }
  PoseTrack track() const {
    constexpr int kPerInterval = 4;
    PoseTrack track;
    for (int i = 0; i < kPerInterval * intervals_; ++i) {
      const double offset_s = step_s_ * i / kPerInterval;
      track.push(stamp_ns(offset_s), at(offset_s));
    }
    track.push(end_ns_, at(duration_s()));
    return track;
  }

 private:
  const Pose& first_;
  const PoseTrack& steady_;
  std::int64_t begin_ns_;
  std::int64_t end_ns_;
  int intervals_;
  double step_s_;
  Eigen::VectorXd corrections_;
};

constexpr std::array<double, 3> kSecondDifference{1.0, -2.0, 1.0};

/// Variance of a second difference for a unit of density.
double difference_variance(double step_s) { return 2.0 / 3.0 * step_s * step_s * step_s; }

/// Normal equations of the corrections.
struct Normal {
  explicit Normal(int knots) : information(Eigen::MatrixXd::Zero(6 * knots, 6 * knots)), gradient(6 * knots) {
    gradient.setZero();
  }

  void add_features(const Knots& knots, const ResidualRows& rows, const std::vector<double>& measured_s) {
    const std::vector<double> weights = robust_weights(rows, kUnitNoiseMad);
    for (int f = 0; f < rows.feature_count(); ++f) {
      const double weight = weights[static_cast<std::size_t>(f)] / kBendInflation;
      if (weight == 0.0) continue;
      const auto [k, share] = knots.place(measured_s[static_cast<std::size_t>(f)]);
      for (int r = rows.first_row(f); r < rows.end_row(f); ++r) {
        Eigen::Matrix<double, 12, 1> jacobian;
        jacobian << share * rows.jacobian(r), (1.0 - share) * rows.jacobian(r);
        information.block<12, 12>(6 * k, 6 * k) += weight * jacobian * jacobian.transpose();
        gradient.segment<12>(6 * k) -= weight * rows.residual(r) * jacobian;
      }
    }
  }

  void add_accelerations(const Knots& knots, const Vector6d& density) {
    const double unit = difference_variance(knots.step_s());
    for (int k = 1; k + 1 < knots.count(); ++k) {
      const Vector6d seen = knots.acceleration(k);
      for (int i = 0; i < 6; ++i) {
        const double weight = 1.0 / (unit * density(i));
        for (int p = 0; p < 3; ++p) {
          const double c = weight * kSecondDifference[static_cast<std::size_t>(p)];
          gradient(6 * (k + p - 1) + i) -= c * seen(i);
          for (int q = 0; q < 3; ++q) {
            information(6 * (k + p - 1) + i, 6 * (k + q - 1) + i) += c * kSecondDifference[static_cast<std::size_t>(q)];
          }
        }
      }
    }
  }

  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

/// Each in B when it was measured.
std::vector<FeaturePoint> as_measured(std::vector<FeaturePoint> features, const PoseTrack& steady, const Knots& knots) {
  const Pose end = knots.at(knots.duration_s());
  for (FeaturePoint& f : features) {
    const Pose then_from_end = steady.at(knots.stamp_ns(static_cast<double>(f.offset_s))).inverse() * end;
    f.position = (then_from_end * f.position.cast<double>()).cast<float>();
    f.normal = then_from_end.rotation.cast<float>() * f.normal;
  }
  return features;
}

/// Expected squares of the accelerations, theirs and their doubt's (an expectation-maximisation step).
Vector6d density_seen(const Knots& knots, const Eigen::MatrixXd& covariance) {
  Vector6d sum = Vector6d::Zero();
  for (int k = 1; k + 1 < knots.count(); ++k) {
    sum += knots.acceleration(k).cwiseAbs2();
    for (int i = 0; i < 6; ++i) {
      for (int p = 0; p < 3; ++p) {
        for (int q = 0; q < 3; ++q) {
          sum(i) += kSecondDifference[static_cast<std::size_t>(p)] * kSecondDifference[static_cast<std::size_t>(q)] *
                    covariance(6 * (k + p - 1) + i, 6 * (k + q - 1) + i);
        }
      }
    }
  }
  return sum / (knots.intervals() * difference_variance(knots.step_s()));
}

}  // namespace

void SweepBends::begin_at(const Pose& world_from_body) {
  last_but_one_knot_ = last_knot_ = world_from_body;
  knots_covariance_.setZero();
  for (std::size_t i = 0; i < kFirstSigmas.size(); ++i) {
    knots_covariance_.diagonal()
        .segment<3>(3 * static_cast<Eigen::Index>(i))
        .setConstant(kFirstSigmas[i] * kFirstSigmas[i]);
  }
  density_.setConstant(kFirstDensity);
  sweeps_ = 0;
  winding_ = {};
}

Vector6d SweepBends::Winding::unwound(const Vector6d& motion) {
  sign_ = -sign_;
  const Vector6d alternating = 0.5 * sign_ * (motion - std::exchange(last_motion_, motion));
  if (++sweeps_ == 1) return Vector6d::Zero();  // nothing to compare with
  const double share = 1.0 / std::min(kWindingsRemembered, sweeps_ - 1.0);
  mean_ += share * (alternating - mean_);
  mean_square_ += share * (alternating.cwiseAbs2() - mean_square_);
  Vector6d unwinding = Vector6d::Zero();
  if (sweeps_ < kLeastWindings) return unwinding;
  for (int i = 0; i < 6; ++i) {
    const double square = mean_(i) * mean_(i);
    const double variance = std::max(0.0, mean_square_(i) - square) * share / (2.0 - share);
    if (square > kClearly * variance) {
      unwinding(i) = -kUnwoundShare * sign_ * mean_(i) * (1.0 - kClearly * variance / square);
    }
  }
  last_motion_ += unwinding;
  return unwinding;
}

PoseTrack SweepBends::bent(const PoseTrack& steady, const FeatureCloud& features, std::int64_t begin_ns,
                           std::int64_t end_ns, const PosePrior& end, ScanMatcher& map) {
  if (std::abs(seconds_between(last_end_ns_, begin_ns)) > kKnotStep_s) begin_at(steady.at(begin_ns));
  last_end_ns_ = end_ns;
  Knots knots(last_but_one_knot_, steady, begin_ns, end_ns);
  const FeatureCloud used{
      as_measured(every_nth(features.edges, kBendBudget), steady, knots),
      as_measured(pick(features.planes, sample_by_direction(features.planes, kBendBudget)), steady, knots),
      as_measured(every_nth(features.clutter, kBendBudget), steady, knots)};
  const Matrix12d begin_information = knots_covariance_.ldlt().solve(Matrix12d::Identity());
  const Matrix6d end_information = end.covariance.ldlt().solve(Matrix6d::Identity());
  Eigen::MatrixXd covariance;
  for (int round = 0; round < kBendRounds; ++round) {
    Normal normal(knots.count());
    ResidualRows rows;
    std::vector<double> measured_s;
    map.constrain(
        used, [&](double offset_s) { return knots.at(offset_s); }, rows, measured_s);
    normal.add_features(knots, rows, measured_s);
    normal.add_accelerations(knots, density_);
    Vector12d off_begin;
    off_begin << -knots.corrections().head<6>(), knots.knot(1).local(last_knot_);
    normal.information.topLeftCorner<12, 12>() += begin_information;
    normal.gradient.head<12>() += begin_information * off_begin;
    normal.information.bottomRightCorner<6, 6>() += end_information;
    normal.gradient.tail<6>() += end_information * knots.knot(knots.count() - 1).local(end.mean);
    for (int k = 0; k < knots.count() && !turns_; ++k) {
      normal.information.diagonal().segment<3>(6 * k).array() += kNoTurn;
    }
    const Eigen::LDLT<Eigen::MatrixXd> factor(normal.information);
    const Eigen::VectorXd step = factor.solve(normal.gradient);
    if (!step.allFinite()) return steady;
    knots.correct(step);
    if (round + 1 == kBendRounds) covariance = factor.solve(Eigen::MatrixXd::Identity(step.size(), step.size()));
  }
  knots_covariance_ = covariance.bottomRightCorner<12, 12>();
  density_ += (density_seen(knots, covariance) - density_) / std::min(kSweepsRemembered, ++sweeps_ + 1.0);
  density_ = density_.cwiseMax(kLeastDensity);
  knots.turn_about_middle(winding_.unwound(knots.knot(1).local(knots.knot(knots.count() - 1))));
  last_but_one_knot_ = knots.knot(knots.count() - 2);
  last_knot_ = knots.knot(knots.count() - 1);
  return knots.track();
}

}  // namespace plumbline
