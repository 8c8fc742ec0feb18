#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/geometry/interpolation.h"
#include "estimator/lidar/sweep_assembler.h"
#include "estimator/localization/map_localizer.h"
#include "estimator/localization/particle_filter.h"
#include "estimator/localization/scan_stack.h"
#include "estimator/localization/smooth_correction.h"
#include "estimator/pipeline/message_gate.h"

namespace plumbline {

enum class LocalizationMethod { kScanMatching, kParticleFilter };

struct LocalizationConfig {
  LocalizationMethod method = LocalizationMethod::kScanMatching;
  double rate_hz = 0.5;  ///< of matches; scans are stacked over their period
  Pose map_from_start;   ///< where on the map odometry's world lies
  bool remapping = true;
};

/// Any odometry, localized on a prior map (thesis 8.2): odometry drives, and every two seconds what the lidar saw since
/// is held against the map. Its outputs are odometry's, seen from the map; while map and scans disagree the last
/// correction is held and odometry goes on.
class LocalizedEstimator final : public Estimator {
 public:
  LocalizedEstimator(std::unique_ptr<Estimator> odometry, const Calibration& calibration, const PriorMap& map,
                     const LocalizationConfig& config);

  void add(const ImuSample& sample) override;
  void add(const CameraFrame& frame) override { odometry_->add(frame); }
  void add(const DepthFrame& frame) override { odometry_->add(frame); }
  void add(const LidarScan& scan) override;
  std::vector<Odometry> take() override;
  MessageCounts counts(Module module) const override { return odometry_->counts(module); }
  std::vector<TrackedFeature> features() const override { return odometry_->features(); }
  /// What the matched stacks saw, in the prior map's frame.
  std::vector<MapPoint> map() const override { return seen_.map(); }

 private:
  void stack(const LidarScan& part);
  void match(std::int64_t stamp_ns, Odometry& odometry);
  void count_blind_way(const Odometry& odometry, double step_m);
  Odometry localized(Odometry odometry);
  const AgreementGate& gate() const;

  std::unique_ptr<Estimator> odometry_;
  Calibration calibration_;
  std::int64_t period_ns_;
  MessageGate scans_;  ///< checks them and holds them until odometry has reached their ends
  SweepAssembler sweeps_;
  PoseTrack track_;  ///< odometry_from_body
  ScanStack stack_;
  std::variant<MapLocalizer, ParticleFilter> localizer_;
  SmoothCorrection correction_;
  ScanMatcher seen_;  ///< for its map
  std::int64_t newest_scan_ns_ = 0;
  std::optional<std::int64_t> last_match_ns_;  ///< the first scan's start before there is one
  double stacking_s_ = 0.0;                    ///< since the last match
  double path_m_ = 0.0;
  double blind_m_ = 0.0;  ///< of path_m_
  std::optional<std::int64_t> last_seen_ns_;  ///< vision's last solution
  Matrix6d covariance_ = Matrix6d::Zero();  ///< on the map
  std::vector<Odometry> outputs_;
};

}  // namespace plumbline
