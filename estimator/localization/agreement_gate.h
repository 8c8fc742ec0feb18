#pragma once

#include <optional>

#include "estimator/estimator.h"

namespace plumbline {

/// How far odometry may have drifted since a known pose. The matcher's prior, the particle filter's motion model and
/// the gate all believe odometry alike.
struct OdometryDrift {
  double sigma_m = 0.02;              ///< what a turn or a match of its own may shift it at once
  double sigma_per_metre = 0.01;      ///< 1 % is several times what it does on a good day
  double sigma_rad = 5e-4;            ///< likewise, of rotation
  double sigma_rad_per_metre = 2e-5;  ///< twice what heading drifts in flight over a field, with a camera

  double translation_sigma(double travelled_m) const { return sigma_m + sigma_per_metre * travelled_m; }
  double rotation_sigma(double travelled_m) const { return sigma_rad + sigma_rad_per_metre * travelled_m; }
};

/// Where a match says that the body is, and how well map and scans go together there.
struct MatchEvidence {
  Pose map_from_body;
  int well_conditioned = 0;
  double overlap = 0.0;       ///< share of what is seen that the map has surfaces near
  double support = 0.0;       ///< see map_support()
  double inlier_share = 0.0;  ///< of the matched features, those that fit
};

/// Decides which matches may move the estimate, and whether it is localized. Two matches in a row have to say the same
/// before the first is believed: on a wrong map each finds a fit of its own.
class AgreementGate {
 public:
  /// Of all planes seen near the map. Measured: where the map is right at least 0.13 is borne out, even by a map that a
  /// level lidar made for one that looks 45 degrees down, and nine rows in ten fit. Three metres along a hall or a
  /// garage 0.07 is borne out at most; one metre off it may be 0.19, of rows of which fewer than eight in ten fit.
  static constexpr double kLeastSupport = 0.1;

  /// Of MatchEvidence::support. Once the body has been found, odometry says where it is to decimetres, and the map need
  /// not tell that place from all others.
  struct LeastSupport {
    double at_start = kLeastSupport;
    double once_found = kLeastSupport;
  };

  AgreementGate(const Pose& map_from_start, const LeastSupport& least) : least_support_(least), held_(map_from_start) {}

  MapAgreement judge(const MatchEvidence& evidence, const Pose& odometry_from_body);

  /// Of the last match that was believed; the start's before there is one.
  const Pose& map_from_odometry() const { return held_; }
  /// Where the next match had best look: as above, or where an unconfirmed one was.
  const Pose& expected_map_from_odometry() const { return candidate_ ? *candidate_ : held_; }
  /// Distance travelled since the last match that was believed [m].
  double travelled_m() const { return travelled_m_; }
  bool localized() const { return localized_; }
  /// Has been localized at least once.
  bool found() const { return found_; }

 private:
  MapAgreement shape(const MatchEvidence& evidence) const;
  bool confirms(const Pose& map_from_body, const Pose& odometry_from_body) const;
  bool too_far(const Pose& map_from_body, const Pose& odometry_from_body) const;

  LeastSupport least_support_;
  Pose held_;
  std::optional<Pose> candidate_;
  bool localized_ = false;
  bool found_ = false;
  int refused_ = 0;  ///< in a row
  double travelled_m_ = 0.0;
  std::optional<Eigen::Vector3d> last_position_;
};

}  // namespace plumbline
