#pragma once

#include <optional>

#include "estimator/estimator.h"

namespace plumbline {

/// A way that odometry has gone.
struct OdometryWay {
  double travelled_m = 0.0;
  double blind_m = 0.0;  ///< of these, without a solution from images
};

/// Where odometry says that the body is, and how it came there.
struct OdometryReading {
  Pose odometry_from_body;
  double blind_m = 0.0;  ///< travelled without a solution from images since the start
};

/// How far odometry may have drifted on a way. The matcher's prior, the particle filter's motion model and the gate all
/// believe odometry alike.
struct OdometryDrift {
  double sigma_m = 0.02;                    ///< what a turn or a match of its own may shift it at once
  double sigma_per_metre = 0.01;            ///< 1 % is several times what it does on a good day
  double sigma_rad = 5e-4;                  ///< likewise, of rotation
  double sigma_rad_per_metre = 2e-5;        ///< twice what heading drifts in flight over a field, with a camera
  double sigma_rad_per_blind_metre = 2e-4;  ///< without one: a degree in a hundred metres among trees

  double translation_sigma(const OdometryWay& way) const { return sigma_m + sigma_per_metre * way.travelled_m; }
  double rotation_sigma(const OdometryWay& way) const {
    return sigma_rad + sigma_rad_per_metre * way.travelled_m + sigma_rad_per_blind_metre * way.blind_m;
  }
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

  MapAgreement judge(const MatchEvidence& evidence, const OdometryReading& odometry);

  /// Of the last match that was believed; the start's before there is one.
  const Pose& map_from_odometry() const { return held_; }
  /// Where the next match had best look: as above, or where an unconfirmed one was.
  const Pose& expected_map_from_odometry() const { return candidate_ ? *candidate_ : held_; }
  /// Since the last match that was believed, up to the last judged.
  const OdometryWay& way() const { return way_; }
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
  OdometryWay way_;
  std::optional<OdometryReading> last_;
};

}  // namespace plumbline
