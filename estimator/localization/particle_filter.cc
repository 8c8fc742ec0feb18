#include "estimator/localization/particle_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/geometry/interpolation.h"
#include "estimator/lidar/direction_sampling.h"
#include "estimator/localization/map_support.h"
#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kFieldVoxel_m = 10.0;
constexpr double kResolution_m = 0.4;  // as the matcher's
constexpr int kFieldNeighbours = 10;
constexpr double kReach_m = 1.0;
constexpr int kPoints = 2000;  // likewise

// The likelihood field of Thrun, Burgard and Fox, Probabilistic Robotics (2005), 6.4: of a return's end point at
// distance d from the map, z_hit N(d; 0, sigma) + z_rand / z_max, as a product over the returns. The thesis does not
// say what it took; its measure is the distance from a point to its patch of the map, and so is d here. Returns of one
// scan are far from independent, for which the book (6.3.4) raises the product to a power below one.
constexpr double kHitShare = 0.9;
constexpr double kRandomShare = 0.1;
constexpr double kSigma_m = 0.05;
constexpr double kPower = 0.1;
constexpr double kDriftInterval_s = 2.0;  // over which OdometryDrift tells the drift at rest
constexpr double kOnMap_m = 0.08;
constexpr double kLeastInformation = 1000.0;  // the matcher's threshold, for our larger sigma

double hit_density(double distance_m) {
  const double z = distance_m / kSigma_m;
  return std::exp(-0.5 * z * z) / (kSigma_m * std::sqrt(2.0 * std::numbers::pi));
}

std::vector<FeaturePoint> sample(const FeatureCloud& stack) {
  std::vector<FeaturePoint> picked;
  for (const std::uint32_t i : sample_by_direction(stack.planes, kPoints)) picked.push_back(stack.planes[i]);
  return picked;
}

/// The mean as seen from one of them, which is enough for poses that lie close together.
Pose mean_of(const std::vector<Pose>& poses, const std::vector<double>& weights) {
  Vector6d mean = Vector6d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) mean += weights[i] * poses.front().local(poses[i]);
  return poses.front().retract(mean);
}

Matrix6d spread_of(const std::vector<Pose>& poses, const std::vector<double>& weights, const Pose& mean) {
  Matrix6d spread = Matrix6d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector6d off = mean.local(poses[i]);
    spread += weights[i] * off * off.transpose();
  }
  return spread;
}

}  // namespace

ParticleFilter::ParticleFilter(const Calibration& calibration, const PriorMap& map, const Pose& map_from_start)
    : planes_(kFieldVoxel_m, kResolution_m),
      occupancy_(map.surfaces),
      gate_(map_from_start, {}),
      random_(kSeed),
      map_from_body_(kParticles, map_from_start) {
  limits_.map_sigma_m = 0.5 * calibration.lidar_range_sigma_m;
  for (const FeaturePoint& f : map.surfaces.planes) planes_.insert({f.position.cast<double>(), f.normal}, 0.0F, 0.0);
}

/// [0, 1)
double ParticleFilter::uniform() { return static_cast<double>(random_() >> 11) * 0x1.0p-53; }

/// Box and Muller's.
double ParticleFilter::gaussian() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

/// The drift that is not the way's is taken for a random walk, told for an interval of the matcher's.
void ParticleFilter::move_by(const Pose& motion, double blind_m, double seconds) {
  OdometryDrift drift;
  const double share = std::sqrt(std::clamp(seconds / kDriftInterval_s, 0.0, 1.0));
  drift.sigma_m *= share;
  drift.sigma_rad *= share;
  const OdometryWay way{motion.translation.norm(), blind_m};
  for (Pose& particle : map_from_body_) {
    Vector6d noise;
    for (int i = 0; i < 3; ++i) noise[i] = drift.rotation_sigma(way) * gaussian();
    for (int i = 3; i < 6; ++i) noise[i] = drift.translation_sigma(way) * gaussian();
    particle = (particle * motion).retract(noise);
  }
}

ParticleFilter::Likelihood ParticleFilter::likelihood(const std::vector<FeaturePoint>& points,
                                                      const Pose& map_from_body) const {
  Likelihood result;
  for (const FeaturePoint& f : points) {
    const Eigen::Vector3d place = map_from_body * f.position.cast<double>();
    const Eigen::Vector3d normal = map_from_body.rotation * f.normal.cast<double>();
    NearestSamples nearest(kFieldNeighbours, kReach_m, normal.cast<float>());
    planes_.nearest(place, kReach_m, nearest);
    const auto patch = fit_plane(nearest, limits_, place);
    double density = kRandomShare / kReach_m;
    if (patch) {
      const double distance_m = std::abs(patch->normal.dot(place) - patch->offset);
      density += kHitShare * hit_density(distance_m);
      if (distance_m < kOnMap_m) result.on_map.push_back(f);
    }
    result.log += kPower * std::log(density);
  }
  return result;
}

std::vector<double> ParticleFilter::weigh(const std::vector<FeaturePoint>& points) const {
  std::vector<double> weights;
  for (const Pose& particle : map_from_body_) weights.push_back(likelihood(points, particle).log);
  const double best = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  for (double& weight : weights) sum += weight = std::exp(weight - best);
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Low-variance sampling (Probabilistic Robotics, Table 4.4): one draw for all.
void ParticleFilter::resample(const std::vector<double>& weights) {
  std::vector<Pose> drawn;
  const double step = 1.0 / kParticles;
  const double start = step * uniform();
  double sum = weights.front();
  std::size_t i = 0;
  for (int m = 0; m < kParticles; ++m) {
    while (start + m * step > sum && i + 1 < weights.size()) sum += weights[++i];
    drawn.push_back(map_from_body_[i]);
  }
  map_from_body_ = std::move(drawn);
}

MapFix ParticleFilter::locate(std::int64_t stamp_ns, const FeatureCloud& stack, const OdometryReading& odometry) {
  const StopWatch watch;
  const std::vector<FeaturePoint> points = sample(stack);
  // Until the first update the particles stand where odometry started.
  const double seconds = last_odometry_ ? seconds_between(last_ns_, stamp_ns) : kDriftInterval_s;
  const Pose& odometry_from_body = odometry.odometry_from_body;
  const OdometryReading last = last_odometry_.value_or(OdometryReading{});
  move_by(last.odometry_from_body.inverse() * odometry_from_body, odometry.blind_m - last.blind_m, seconds);
  last_odometry_ = odometry;
  last_ns_ = stamp_ns;
  const Pose predicted = gate_.expected_map_from_odometry() * odometry_from_body;
  std::vector<Eigen::Vector3d> places;
  for (const FeaturePoint& f : points) places.push_back(predicted * f.position.cast<double>());
  planes_.prepare(places);
  const std::vector<double> weights = weigh(points);

  const Pose mean = mean_of(map_from_body_, weights);
  const std::vector<FeaturePoint> on_map = likelihood(points, mean).on_map;
  MatchEvidence evidence;
  evidence.map_from_body = mean;
  evidence.well_conditioned = 6;  // it cannot tell
  evidence.overlap = occupancy_.share_near(stack, mean);
  evidence.inlier_share = 1.0;
  evidence.support = 1.0;  // a filter is its own judge; what the map bears out is told all the same

  MapFix fix;
  fix.covariance = spread_of(map_from_body_, weights, evidence.map_from_body);
  resample(weights);
  const Vector6d correction = predicted.local(evidence.map_from_body);
  fix.match.stamp_ns = stamp_ns;
  fix.match.agreement = gate_.judge(evidence, odometry);
  fix.match.overlap = evidence.overlap;
  fix.match.support = map_support(plane_information(planes_near(points, occupancy_, mean), kSigma_m, kNormalSigma),
                                  plane_information(on_map, kSigma_m, 0.0), kLeastInformation);
  fix.match.correction_rad = correction.head<3>().norm();
  fix.match.correction_m = correction.tail<3>().norm();
  fix.match.iterations = 1;
  fix.match.processing_s = watch.seconds();
  fix.health.stamp_ns = stamp_ns;
  fix.health.module = Module::kLocalization;
  fix.health.mode = ModuleMode::kSolved;
  fix.health.well_conditioned = 6;
  fix.health.rows = static_cast<int>(points.size());
  fix.health.inliers = static_cast<int>(on_map.size());
  fix.health.correction = correction;
  fix.health.processing_s = fix.match.processing_s;
  return fix;
}

}  // namespace plumbline
