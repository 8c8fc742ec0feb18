#include "estimator/vision/bundle_adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <map>

#include "estimator/vision/motion_constraints.h"

namespace plumbline {
namespace {

constexpr double kDefaultInverseDepth = 0.1;  // [1/m] of a feature without depth, as a first guess
/// Inliers of the frame-to-frame motion still hold depths taken across an edge: beyond this many sigma a row loses
/// pull.
constexpr double kRobustSigma = 2.0;
/// Of the frame-to-frame motion between neighbouring images, negligible beside what the features say (thesis 3.5).
constexpr double kMotionRotationSigma = 0.05;  // [rad]
constexpr double kMotionTranslationSigma_m = 0.2;

using PoseBlock = std::array<double, 7>;      // quaternion x, y, z, w; translation
using LandmarkBlock = std::array<double, 3>;  // x / z, y / z, 1 / z in the camera that saw it first

PoseBlock block_of(const Pose& pose) {
  const auto& q = pose.rotation;
  const auto& t = pose.translation;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Pose pose_of(const PoseBlock& block) {
  return {Eigen::Quaterniond(block[3], block[0], block[1], block[2]).normalized(),
          Eigen::Vector3d(block[4], block[5], block[6])};
}

template <typename T>
Eigen::Quaternion<T> rotation_in(const T* block) {
  return Eigen::Quaternion<T>(block[3], block[0], block[1], block[2]);
}

template <typename T>
Eigen::Matrix<T, 3, 1> translation_in(const T* block) {
  return {block[4], block[5], block[6]};
}

/// A feature in the camera now over its depth in the camera that saw it first: R^T (ray + rho t) in both's frames.
template <typename T>
Eigen::Matrix<T, 3, 1> scaled_point(const T* first_from_anchor, const T* first_from_now, const T* landmark) {
  const Eigen::Matrix<T, 3, 1> ray(landmark[0], landmark[1], T(1.0));
  const Eigen::Matrix<T, 3, 1> moved =
      rotation_in(first_from_anchor) * ray +
      landmark[2] * (translation_in(first_from_anchor) - translation_in(first_from_now));
  return rotation_in(first_from_now).conjugate() * moved;
}

/// Both pixel coordinates of a later sighting, and those of the first one, over the tracking noise.
struct PixelError {
  Eigen::Vector2d ray;
  Eigen::Vector2d weight;  ///< focal length over pixel noise

  template <typename T>
  bool operator()(const T* first_from_anchor, const T* first_from_now, const T* landmark, T* residual) const {
    const auto point = scaled_point(first_from_anchor, first_from_now, landmark);
    if (point.z() < T(0.5 * kLeastDepthRatio)) return false;
    residual[0] = weight.x() * (point.x() / point.z() - ray.x());
    residual[1] = weight.y() * (point.y() / point.z() - ray.y());
    return true;
  }
};

struct AnchorPixelError {
  Eigen::Vector2d ray;
  Eigen::Vector2d weight;

  template <typename T>
  bool operator()(const T* landmark, T* residual) const {
    residual[0] = weight.x() * (landmark[0] - ray.x());
    residual[1] = weight.y() * (landmark[1] - ray.y());
    return true;
  }
};

/// Depth as inverse depth, in which its noise is Gaussian.
struct DepthError {
  InverseDepth seen;

  template <typename T>
  bool operator()(const T* first_from_anchor, const T* first_from_now, const T* landmark, T* residual) const {
    const auto point = scaled_point(first_from_anchor, first_from_now, landmark);
    if (point.z() < T(0.5 * kLeastDepthRatio)) return false;
    residual[0] = (landmark[2] / point.z() - seen.mean) / seen.sigma;
    return true;
  }
};

struct AnchorDepthError {
  InverseDepth seen;

  template <typename T>
  bool operator()(const T* landmark, T* residual) const {
    residual[0] = (landmark[2] - seen.mean) / seen.sigma;
    return true;
  }
};

struct MotionError {
  Pose previous_from_now;

  template <typename T>
  bool operator()(const T* first_from_previous, const T* first_from_now, T* residual) const {
    const Eigen::Quaternion<T> previous_from_first = rotation_in(first_from_previous).conjugate();
    const Eigen::Quaternion<T> turned =
        previous_from_now.rotation.conjugate().cast<T>() * (previous_from_first * rotation_in(first_from_now));
    const Eigen::Matrix<T, 3, 1> moved =
        previous_from_first * (translation_in(first_from_now) - translation_in(first_from_previous));
    for (int i = 0; i < 3; ++i) {
      residual[i] = T(2.0 / kMotionRotationSigma) * turned.vec()[i];
      residual[3 + i] = (moved[i] - previous_from_now.translation[i]) / kMotionTranslationSigma_m;
    }
    return true;
  }
};

struct Track {
  struct Sight {
    std::size_t image = 0;
    const FrameToFrame::Sighting* sighting = nullptr;
  };
  std::vector<Sight> sights;
  LandmarkBlock landmark{};
};

class Bundle {
 public:
  Bundle(const std::vector<BundleImage>& images, const Calibration& calibration)
      : images_(images), camera_(calibration.camera), body_from_camera_(calibration.body_from_camera) {
    const Pose first_from_odometry = (images.front().odometry_from_body * body_from_camera_).inverse();
    for (const BundleImage& image : images) {
      poses_.push_back(block_of(first_from_odometry * image.odometry_from_body * body_from_camera_));
    }
    gather_tracks();
  }

  int least_shared_tracks() const {
    std::vector<int> shared(images_.size() - 1, 0);
    for (const auto& [id, track] : tracks_) {
      for (std::size_t i = track.sights.front().image; i < track.sights.back().image; ++i) ++shared[i];
    }
    return *std::min_element(shared.begin(), shared.end());
  }

  bool solve() {
    ceres::Problem problem;
    const auto manifold = [] {
      return new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
    };
    for (PoseBlock& pose : poses_) problem.AddParameterBlock(pose.data(), 7, manifold());
    problem.SetParameterBlockConstant(poses_.front().data());
    for (auto& [id, track] : tracks_) add(problem, track);
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      const Pose previous_from_now = pose_of(poses_[i - 1]).inverse() * pose_of(poses_[i]);
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<MotionError, 6, 7, 7>(new MotionError{previous_from_now}), nullptr,
          poses_[i - 1].data(), poses_[i].data());
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.num_threads = 1;  // the same sums in the same order
    options.max_num_iterations = 15;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.IsSolutionUsable();
  }

  std::vector<Pose> first_body_from_body() const {
    std::vector<Pose> poses;
    for (const PoseBlock& block : poses_) {
      poses.push_back(body_from_camera_ * pose_of(block) * body_from_camera_.inverse());
    }
    return poses;
  }

 private:
  Eigen::Vector2d ray_of(const FrameToFrame::Sighting& sighting) const {
    return ray_through(camera_, sighting.pixel).head<2>();
  }

  void gather_tracks() {
    for (std::size_t i = 0; i < images_.size(); ++i) {
      for (const FrameToFrame::Sighting& s : images_[i].sightings) tracks_[s.id].sights.push_back({i, &s});
    }
    std::erase_if(tracks_, [](const auto& entry) { return entry.second.sights.size() < 2; });
    for (auto& [id, track] : tracks_) {
      const FrameToFrame::Sighting& anchor = *track.sights.front().sighting;
      const Eigen::Vector2d ray = ray_of(anchor);
      const bool known = anchor.source != DepthSource::kNone;
      track.landmark = {ray.x(), ray.y(), known ? anchor.depth.mean : kDefaultInverseDepth};
    }
    std::erase_if(tracks_, [this](const auto& entry) { return leaves_the_view(entry.second); });
  }

  bool leaves_the_view(const Track& track) const {
    const double* anchor = poses_[track.sights.front().image].data();
    return std::any_of(track.sights.begin(), track.sights.end(), [&](const Track::Sight& sight) {
      return scaled_point(anchor, poses_[sight.image].data(), track.landmark.data()).z() < kLeastDepthRatio;
    });
  }

  void add(ceres::Problem& problem, Track& track) {
    double* landmark = track.landmark.data();
    problem.AddParameterBlock(landmark, 3);
    double* anchor = poses_[track.sights.front().image].data();
    for (std::size_t k = 0; k < track.sights.size(); ++k) {
      const FrameToFrame::Sighting& s = *track.sights[k].sighting;
      double* now = poses_[track.sights[k].image].data();
      const Eigen::Vector2d ray = ray_of(s);
      const Eigen::Vector2d weight = Eigen::Vector2d(camera_.fx, camera_.fy) / s.pixel_sigma;
      // Depth from the motion itself repeats what these very images say: it starts the solution and no more.
      const bool has_depth = s.source != DepthSource::kNone && s.source != DepthSource::kTriangulated;
      if (k == 0) {
        add_row<ceres::AutoDiffCostFunction<AnchorPixelError, 2, 3>, ceres::HuberLoss>(
            problem, AnchorPixelError{ray, weight}, landmark);
        if (has_depth) {
          add_row<ceres::AutoDiffCostFunction<AnchorDepthError, 1, 3>, ceres::CauchyLoss>(
              problem, AnchorDepthError{s.depth}, landmark);
        }
      } else {
        add_row<ceres::AutoDiffCostFunction<PixelError, 2, 7, 7, 3>, ceres::HuberLoss>(problem, PixelError{ray, weight},
                                                                                       anchor, now, landmark);
        if (has_depth) {
          add_row<ceres::AutoDiffCostFunction<DepthError, 1, 7, 7, 3>, ceres::CauchyLoss>(problem, DepthError{s.depth},
                                                                                          anchor, now, landmark);
        }
      }
    }
  }

  template <typename Cost, typename Loss, typename Error, typename... Blocks>
  void add_row(ceres::Problem& problem, const Error& error, Blocks*... blocks) {
    problem.AddResidualBlock(new Cost(new Error(error)), new Loss(kRobustSigma), blocks...);
  }

  const std::vector<BundleImage>& images_;
  CameraIntrinsics camera_;
  Pose body_from_camera_;
  std::vector<PoseBlock> poses_;  ///< first camera from camera
  std::map<std::int64_t, Track> tracks_;
};

}  // namespace

std::optional<std::vector<Pose>> adjust_bundle(const std::vector<BundleImage>& images, const Calibration& calibration,
                                               const BundleConfig& config) {
  if (images.size() < 2) return std::nullopt;
  Bundle bundle(images, calibration);
  if (bundle.least_shared_tracks() < config.least_shared_tracks || !bundle.solve()) return std::nullopt;
  const std::vector<Pose> poses = bundle.first_body_from_body();
  const bool finite = std::all_of(poses.begin(), poses.end(), [](const Pose& pose) {
    return pose.translation.allFinite() && pose.rotation.coeffs().allFinite();
  });
  return finite ? std::optional(poses) : std::nullopt;
}

}  // namespace plumbline
