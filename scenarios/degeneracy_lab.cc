#include "scenarios/degeneracy_lab.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/scan_matcher.h"
#include "scenarios/calibration.h"
#include "scenarios/scan_stream.h"
#include "scenarios/session.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr std::int64_t kKnot_ns = 5'000'000;
constexpr std::int64_t kWarmUp_ns = 1'000'000'000;

// How far off the guess is: what the IMU and vision leave to a match.
constexpr double kGuess_m = 0.02;
constexpr double kGuess_rad = 0.003;

// Errors of the prediction that mitigations start from, per scan.
constexpr double kReckoningScale = 0.01;
constexpr double kReckoning_m = 0.003;
constexpr double kReckoning_rad = 0.0005;
constexpr int kSteps = 2;  // with the correspondences found anew for each

// A selected point belongs to the true surface that the ray towards it meets within this; beyond, it is a mixed return.
constexpr double kOnSurface_m = 0.15;
constexpr std::size_t kLeastSurfaces = 30;

struct TruePlane {
  Eigen::Vector3d point_in_body;     ///< as measured
  Eigen::Vector3d normal_in_world;   ///< of the true surface
  Eigen::Vector3d surface_in_world;  ///< a point of it
};

ScanMatcherConfig one_step_at_a_time() {
  ScanMatcherConfig config;
  config.max_iterations = 1;
  return config;
}

/// Scan matching that mitigates degeneracy in one way, on the map that it makes itself.
class MitigatedMatching {
 public:
  MitigatedMatching(Mitigation mitigation, const Calibration& calibration)
      : mitigation_(mitigation),
        range_sigma_m_(calibration.lidar_range_sigma_m),
        matcher_(calibration, one_step_at_a_time()) {}

  void start(const FeatureCloud& features, const Pose& world_from_body) {
    pose_ = world_from_body;
    matcher_.insert(features, pose_, 0.0);
  }

  /// @param covariance  of the predicted motion
  void add(const FeatureCloud& features, const Pose& last_from_body, const Matrix6d& covariance) {
    const Pose predicted = pose_ * last_from_body;
    Pose found = predicted;
    for (int i = 0; i < kSteps; ++i) {
      matcher_.match(features, {found, Matrix6d::Identity()});
      StepContext context;
      context.threshold = ScanMatcherConfig{}.degeneracy_threshold;
      context.range_sigma_m = range_sigma_m_;
      context.moved = predicted.local(found);
      context.prior_covariance = covariance;
      found = found.retract(mitigated_step(mitigation_, matcher_.rows(), context));
    }
    path_m_ += last_from_body.translation.norm();
    pose_ = found;
    matcher_.insert(features, pose_, path_m_);
  }

  const Pose& pose() const { return pose_; }

 private:
  Mitigation mitigation_;
  double range_sigma_m_;
  ScanMatcher matcher_;
  Pose pose_;
  double path_m_ = 0.0;
};

class Lab {
 public:
  Lab(const Scenario& scenario, const World& world, const RayScene& rays)
      : scenario_(scenario),
        own_body_(make_own_body(scenario)),
        surroundings_{world, rays, own_body_.get()},
        world_from_pack_(make_body_trajectory(scenario, world, rays)),
        calibration_(true_calibration(scenario.rig)),
        pack_from_body_(Eigen::Quaterniond::Identity(), scenario.rig.imu.position_in_body),
        truth_(scenario.rig.lidar, calibration_.body_from_lidar),
        matcher_(calibration_, ScanMatcherConfig{}),
        guesses_(scenario.seed, "degeneracy lab"),
        reckoning_(scenario.seed, "degeneracy lab reckoning") {
    for (const Mitigation mitigation : kMitigations) matchings_.emplace_back(mitigation, calibration_);
  }

  LabRun run(const std::function<bool(double)>& progress) {
    ScanStream scans(scenario_, surroundings_, world_from_pack_);
    LabRun run;
    while (const auto message = scans.next()) {
      const auto& scan = std::get<LidarScan>(message->payload);
      take(scan, run);
      const double share = static_cast<double>(scan.end_ns) / static_cast<double>(world_from_pack_.end_ns());
      if (progress && !progress(share)) break;
    }
    return run;
  }

 private:
  /// The extrinsics as they are, not as the estimator is told.
  static Calibration true_calibration(const RigConfig& rig) {
    Calibration calibration = calibration_of(rig);
    calibration.body_from_lidar = Pose{Eigen::Quaterniond::Identity(), -rig.imu.position_in_body} * rig.pack_from_lidar;
    return calibration;
  }

  PoseTrack true_track(const LidarScan& scan) const {
    PoseTrack track;
    for (std::int64_t t = scan.stamp_ns; t < scan.end_ns; t += kKnot_ns) {
      track.push(t, world_from_pack_.pose(t) * pack_from_body_);
    }
    track.push(scan.end_ns, world_from_pack_.pose(scan.end_ns) * pack_from_body_);
    return track;
  }

  Pose guess_near(const Pose& pose) {
    Vector6d off;
    for (int i = 0; i < 6; ++i) off[i] = (i < 3 ? kGuess_rad : kGuess_m) * guesses_.gaussian();
    return pose.retract(off);
  }

  void take(const LidarScan& scan, LabRun& run) {
    const PoseTrack track = true_track(scan);
    const Pose world_from_body = track.at(scan.end_ns);
    const DeskewedScan deskewed = deskew(scan, track, calibration_.body_from_lidar, scan.end_ns);
    const FeatureCloud features = extract_features(scan, deskewed, calibration_);
    const Pose guess = guess_near(world_from_body);
    if (scan.stamp_ns >= kWarmUp_ns) {
      matcher_.match(features, {guess, Matrix6d::Identity()});
      run.scans.push_back(judged(scan, track));
    }
    mitigate(features, world_from_body);
    run.truth.push_back({scan.end_ns, world_from_body});
    for (std::size_t i = 0; i < matchings_.size(); ++i) run.estimates[i].push_back({scan.end_ns, matchings_[i].pose()});
    path_m_ += last_ ? (world_from_body.translation - last_->translation).norm() : 0.0;
    last_ = world_from_body;
    matcher_.insert(features, world_from_body, path_m_);
  }

  void mitigate(const FeatureCloud& features, const Pose& world_from_body) {
    if (!last_) {
      for (MitigatedMatching& matching : matchings_) matching.start(features, world_from_body);
      return;
    }
    Pose moved = last_->inverse() * world_from_body;
    moved.translation *= 1.0 + kReckoningScale;
    Vector6d error;
    for (int i = 0; i < 6; ++i) error[i] = (i < 3 ? kReckoning_rad : kReckoning_m) * reckoning_.gaussian();
    moved = moved.retract(error);
    const double sigma_m = std::hypot(kReckoning_m, kReckoningScale * moved.translation.norm());
    Matrix6d covariance = Matrix6d::Zero();
    covariance.diagonal() << Eigen::Vector3d::Constant(kReckoning_rad * kReckoning_rad),
        Eigen::Vector3d::Constant(sigma_m * sigma_m);
    for (MitigatedMatching& matching : matchings_) matching.add(features, moved, covariance);
  }

  ScanTrial judged(const LidarScan& scan, const PoseTrack& track) {
    const std::int64_t index = scan.stamp_ns / message_period_ns(truth_.model());
    const auto returns = truth_.cast(surroundings_, track, scan.stamp_ns, index);
    const Matrix6d all = lidar_information(returns.points, calibration_.lidar_range_sigma_m);
    ScanTrial trial;
    trial.stamp_ns = scan.end_ns;
    trial.label = label(all, kLidarLimits);
    for (const SurfacePoint& point : returns.points) {
      trial.mean_range_m += point.position.norm() / static_cast<double>(returns.points.size());
    }
    ask_detectors(trial);
    if (trial.label.worst() == DegeneracyLabel::Class::kWell) register_on_truth(track.at(scan.end_ns), all, trial);
    return trial;
  }

  void ask_detectors(ScanTrial& trial) const {
    const auto degenerate = static_cast<std::size_t>(trial.label.degenerate());
    std::vector<Vector6d> truth;
    for (std::size_t i = 0; i < degenerate; ++i) truth.emplace_back(trial.label.directions.col(static_cast<int>(i)));
    const Matrix6d lidar_from_body = adjoint(calibration_.body_from_lidar.inverse());
    for (std::size_t i = 0; i < kDetectors.size(); ++i) {
      const Detection detection = detect(kDetectors[i], matcher_.rows(), calibration_.lidar_range_sigma_m);
      trial.detectors[i].score = detection.worst();
      if (degenerate == 0) continue;
      std::vector<Vector6d> found;
      for (std::size_t k = 0; k < std::min(degenerate, detection.directions.size()); ++k) {
        found.emplace_back(lidar_from_body * detection.directions[k]);
      }
      trial.detectors[i].angle_rad = largest_principal_angle(found, truth, trial.mean_range_m);
    }
  }

  /// The true surfaces of the points that matching selected.
  std::vector<TruePlane> true_planes(const Pose& world_from_body) const {
    const Eigen::Vector3d origin = (world_from_body * calibration_.body_from_lidar).translation;
    const RayWindow window = surroundings_.rays.window(origin, truth_.model().max_range_m);
    std::vector<TruePlane> planes;
    const Eigen::Vector3d* last = nullptr;
    for (const MatchRow& row : matcher_.rows()) {
      // The two rows of an edge share their point, which lies on no one surface.
      const bool is_edge = last != nullptr && *last == row.point;
      last = &row.point;
      if (is_edge && !planes.empty() && planes.back().point_in_body == row.point) planes.pop_back();
      if (is_edge || row.weight <= 0.0) continue;
      const Eigen::Vector3d point = world_from_body * row.point;
      const Eigen::Vector3d direction = (point - origin).normalized();
      const RayHit hit = window.cast(origin, direction, 0.0, truth_.model().max_range_m, 0.0);
      const Eigen::Vector3d normal = hit.normal_in_world.cast<double>();
      const Eigen::Vector3d surface = origin + hit.range_m * direction;
      if (hit.hit && std::abs(normal.dot(surface - point)) < kOnSurface_m) {
        planes.push_back({row.point, normal, surface});
      }
    }
    return planes;
  }

  void register_on_truth(const Pose& world_from_body, const Matrix6d& all_in_lidar, ScanTrial& trial) {
    const std::vector<TruePlane> planes = true_planes(world_from_body);
    if (planes.size() < kLeastSurfaces) return;
    const double sigma_m = calibration_.lidar_range_sigma_m;
    const auto linearize = [&](const Pose& pose, ResidualRows& rows) {
      for (const TruePlane& plane : planes) {
        const MapPlane surface{plane.normal_in_world, plane.normal_in_world.dot(plane.surface_in_world)};
        add_plane_row(plane.point_in_body, surface, pose, sigma_m, rows);
      }
    };
    // As matching does it: along a direction that the selected points leave open the guess stays, where forcing it
    // would run away by metres.
    SolverOptions options;
    options.degeneracy_threshold = ScanMatcherConfig{}.degeneracy_threshold;
    const SolveResult solved = solve(guess_near(world_from_body), std::nullopt, linearize, options);
    const Vector6d error = world_from_body.local(solved.pose);

    const Eigen::Quaterniond body_from_world = world_from_body.rotation.conjugate();
    std::vector<SurfacePoint> selected;
    for (const TruePlane& plane : planes) {
      selected.push_back({plane.point_in_body, body_from_world * plane.normal_in_world});
    }
    const Matrix6d of_selected = lidar_information(selected, sigma_m);
    const Matrix6d ad = adjoint(calibration_.body_from_lidar.inverse());
    const Matrix6d of_all = ad.transpose() * all_in_lidar * ad;
    trial.error_over_selected = error.dot(of_selected * error) / 6.0;
    trial.error_over_all = error.dot(of_all * error) / 6.0;
  }

  const Scenario& scenario_;
  const std::unique_ptr<OwnBody> own_body_;
  const Surroundings surroundings_;
  const Trajectory world_from_pack_;
  const Calibration calibration_;
  const Pose pack_from_body_;
  const TrueReturns truth_;
  ScanMatcher matcher_;
  RandomStream guesses_;
  RandomStream reckoning_;
  std::vector<MitigatedMatching> matchings_;  ///< as kMitigations
  double path_m_ = 0.0;
  std::optional<Pose> last_;
};

/// An orthonormal basis of the directions' span.
Eigen::MatrixXd basis_of(const std::vector<Vector6d>& directions, double range_m) {
  Eigen::MatrixXd columns(6, static_cast<Eigen::Index>(directions.size()));
  for (std::size_t i = 0; i < directions.size(); ++i) {
    Vector6d direction = directions[i];
    direction.head<3>() *= range_m;
    columns.col(static_cast<Eigen::Index>(i)) = direction.normalized();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(6, columns.cols());
}

}  // namespace

double largest_principal_angle(const std::vector<Vector6d>& found, const std::vector<Vector6d>& truth, double range_m) {
  const Eigen::MatrixXd cosines = basis_of(found, range_m).transpose() * basis_of(truth, range_m);
  const double least = Eigen::JacobiSVD<Eigen::MatrixXd>(cosines).singularValues().minCoeff();
  return std::acos(std::clamp(least, -1.0, 1.0));
}

LabRun run_degeneracy_lab(const Scenario& scenario, const World& world, const RayScene& rays,
                          const std::function<bool(double)>& progress) {
  return Lab(scenario, world, rays).run(progress);
}

}  // namespace plumbline
