#include "estimator/localization/localized_estimator.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "estimator/lidar/deskew.h"
#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

constexpr std::int64_t kCorrectedTrack_ns = MessageGate::kLongestDelay_ns + SweepAssembler::kLongest_ns;
// Scans a tenth of a second apart see the same; the thesis stacks five a second.
constexpr std::int64_t kLeastInterval_ns = 150'000'000;
// A correction is spent before the next one comes; a decimetre in a second is the pace of a slow step aside.
constexpr double kLongestBlend_s = 1.0;
// Images come slower than this only if they do not drive the heading.
constexpr std::int64_t kSeeing_ns = 1'000'000'000;

std::int64_t period_ns(const LocalizationConfig& config) {
  if (!(config.rate_hz >= 0.1 && config.rate_hz <= 20.0)) {
    throw std::invalid_argument("localization: the rate must be 0.1 to 20 Hz");
  }
  return std::llround(1e9 / config.rate_hz);
}

std::variant<MapLocalizer, ParticleFilter> make_localizer(const Calibration& calibration, const PriorMap& map,
                                                          const LocalizationConfig& config) {
  if (config.method == LocalizationMethod::kParticleFilter) {
    return ParticleFilter(calibration, map, config.map_from_start);
  }
  return MapLocalizer(calibration, map, config.map_from_start, config.remapping);
}

MessageUse scans_alone(const Calibration& calibration) {
  MessageUse use;
  use.lidar = true;
  use.own_body = OwnBodyMask(calibration);
  use.imu = false;
  return use;
}

}  // namespace

LocalizedEstimator::LocalizedEstimator(std::unique_ptr<Estimator> odometry, const Calibration& calibration,
                                       const PriorMap& map, const LocalizationConfig& config)
    : odometry_(std::move(odometry)),
      calibration_(calibration),
      period_ns_(period_ns(config)),
      scans_(scans_alone(calibration)),
      stack_(period_ns_),
      localizer_(make_localizer(calibration, map, config)),
      correction_(config.map_from_start, std::min(kLongestBlend_s, 1.0 / config.rate_hz)),
      seen_(calibration, {}) {
  if (!calibration.has_lidar) throw std::invalid_argument("localization: there is no lidar to match the map with");
}

void LocalizedEstimator::add(const ImuSample& sample) {
  scans_.admit(sample);
  odometry_->add(sample);
  for (Odometry& output : odometry_->take()) outputs_.push_back(localized(std::move(output)));
}

void LocalizedEstimator::add(const LidarScan& scan) {
  scans_.admit(scan);
  odometry_->add(scan);
}

std::vector<Odometry> LocalizedEstimator::take() { return std::exchange(outputs_, {}); }

const AgreementGate& LocalizedEstimator::gate() const {
  return std::visit([](const auto& localizer) -> const AgreementGate& { return localizer.gate(); }, localizer_);
}

void LocalizedEstimator::stack(const LidarScan& part) {
  const std::optional<LidarScan> sweep = sweeps_.add(part);
  if (!sweep || !track_.covers(sweep->stamp_ns) || !track_.covers(sweep->end_ns)) return;
  if (last_match_ns_ && sweep->end_ns - newest_scan_ns_ < kLeastInterval_ns) return;
  const StopWatch watch;
  const DeskewedScan deskewed = deskew(*sweep, track_, calibration_.body_from_lidar, sweep->end_ns);
  const Pose pose = track_.at(sweep->end_ns);
  stack_.add(sweep->end_ns, extract_features(*sweep, deskewed, calibration_), pose);
  newest_scan_ns_ = sweep->end_ns;
  if (!last_match_ns_) last_match_ns_ = sweep->stamp_ns;
  stacking_s_ += watch.seconds();
}

/// Matches what was stacked at the newest scan; the fix holds for map_from_odometry, whose time does not matter.
void LocalizedEstimator::match(std::int64_t stamp_ns, Odometry& odometry) {
  last_match_ns_ = newest_scan_ns_;
  const Pose odometry_from_body = stack_.newest_pose();
  const FeatureCloud features = stack_.in_newest_body();
  MapFix fix = std::visit(
      [&](auto& localizer) {
        return localizer.locate(newest_scan_ns_, features, OdometryReading{odometry_from_body, blind_m_});
      },
      localizer_);
  fix.match.processing_s += std::exchange(stacking_s_, 0.0);
  if (fix.match.agreement == MapAgreement::kAgrees) {
    correction_.aim(stamp_ns, odometry.world_from_body, gate().map_from_odometry());
    const Matrix6d solved =
        fix.health.well_conditioned == 6
            ? Matrix6d::Identity()
            : Spectrum{fix.health.eigenvalues, fix.health.eigenvectors, fix.health.well_conditioned}.projector();
    const Matrix6d kept = Matrix6d::Identity() - solved;
    covariance_ = fix.covariance + kept * covariance_ * kept;
  }
  seen_.insert(features, gate().map_from_odometry() * odometry_from_body, path_m_);
  stack_.clear();
  odometry.health.push_back(fix.health);
  odometry.map_matches.push_back(fix.match);
}

/// Any solution of images counts, be it of some directions alone: a turn is the last that they leave open.
void LocalizedEstimator::count_blind_way(const Odometry& odometry, double step_m) {
  for (const ModuleHealth& health : odometry.health) {
    if (health.module == Module::kVision && health.mode != ModuleMode::kBypassed) last_seen_ns_ = health.stamp_ns;
  }
  if (!last_seen_ns_ || odometry.stamp_ns - *last_seen_ns_ > kSeeing_ns) blind_m_ += step_m;
}

Odometry LocalizedEstimator::localized(Odometry odometry) {
  const Pose odometry_from_body = odometry.world_from_body;
  const bool first = track_.empty();
  const Pose last = first ? odometry_from_body : track_.poses().back().pose;
  if (first || odometry.stamp_ns > track_.last_ns()) {
    track_.push(odometry.stamp_ns, odometry_from_body);
    track_.forget_before(odometry.stamp_ns - kCorrectedTrack_ns);
  }
  const Pose body_from_last = odometry_from_body.inverse() * last;
  const double step_m = body_from_last.translation.norm();
  path_m_ += step_m;
  count_blind_way(odometry, step_m);
  const Matrix6d carry = adjoint(body_from_last);
  covariance_ =
      first ? odometry.covariance : Matrix6d(carry * covariance_ * carry.transpose() + odometry.increment_covariance);

  while (const auto message = scans_.next(odometry.stamp_ns)) stack(std::get<LidarScan>(*message));
  if (last_match_ns_ && newest_scan_ns_ - *last_match_ns_ >= period_ns_) match(odometry.stamp_ns, odometry);

  odometry.world_from_body = correction_.map_from_body(odometry.stamp_ns, odometry_from_body);
  const Eigen::Quaterniond turn = odometry.world_from_body.rotation * odometry_from_body.rotation.conjugate();
  odometry.velocity_in_world = turn * odometry.velocity_in_world;
  odometry.localized = gate().localized();
  if (odometry.localized) odometry.covariance = covariance_;
  return odometry;
}

}  // namespace plumbline
