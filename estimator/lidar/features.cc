#include "estimator/lidar/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "estimator/lidar/crease.h"
#include "estimator/lidar/facing_side.h"
#include "estimator/lidar/flat_index.h"
#include "estimator/lidar/poles.h"
#include "estimator/lidar/ring_table.h"

namespace plumbline {
namespace {

// Half the window of (5.12). Ten returns, as LOAM uses, span a few centimetres near the sensor and measure range noise
// there, not shape; so the window holds at least this length of surface, within a least and a largest number of
// returns.
constexpr float kHalfWindow_m = 0.25F;
constexpr int kLeastHalfWindow = 5;
constexpr int kLargestHalfWindow = 40;

// An edge must deviate by this share of its range (thesis: 5e-3; less suffices since noise has its own term) and by
// this many standard deviations of what range noise does to the deviation: of 30,000 returns on smooth walls, 0.2
// exceed 4.5.
constexpr float kEdgeCurvature = 4e-3F;
constexpr float kEdgeSigmas = 4.5F;
// A planar point may deviate by this much.
constexpr float kPlaneCurvature = 1.5e-3F;
constexpr float kPlaneSigmas = 2.5F;

constexpr float kGrazing = 0.1736F;            // sin(10 deg), thesis 4.1: beam to surface
constexpr float kSilhouetteGrazing = 0.3420F;  // sin(20 deg): a run that ends by turning away has no edge at its end
constexpr int kSectors = 4;
constexpr int kEdgesPerSector = 5;
constexpr double kPlaneSpacing_m = 0.25;  // one planar feature a cell of this size and side
constexpr double kClutterSpacing_m = 0.1;
// Points across two rings belong to one surface if they are no further apart than this share of the range, plus a
// little.
constexpr float kCrossLimit = 0.25F;
constexpr float kCrossLimit_m = 0.1F;
constexpr float kCrossBend = 0.90F;  // cos(25 deg): more between the patches above and below is a crease
// Returns of one firing lie within this time of each other.
constexpr std::int32_t kFiring_ns = 60'000;

/// What the ring itself tells about a return.
struct Shape {
  float deviation_m = 0.0F;  // of the return from its neighbours' mean, across the surface
  float sigma_m = 0.0F;      // of the deviation, from range noise
  int half_window = 0;       // 0: too near the end of its run
  Eigen::Vector3f tangent = Eigen::Vector3f::Zero();
};

struct EdgeCandidate {
  int index = 0;
  int half_window = 0;
  float score = 0.0F;
  std::optional<Eigen::Vector3f> step;  // of silhouettes only: to where the next beam passed the edge
};

/// One feature for all points of a cell and side: their mean, with the sum of their normals.
class Cells {
 public:
  explicit Cells(double spacing_m) : per_m_(1.0 / spacing_m) {}

  void add(const FeaturePoint& point) {
    const Eigen::Vector3i cell = cell_of(point.position.cast<double>(), per_m_);
    const auto fresh = static_cast<std::uint32_t>(means.size());
    const std::uint32_t at = index_.find_or_insert(pack_cell(cell, facing_side(point.normal)), fresh);
    if (at == fresh) {
      means.push_back(point);
      counts_.push_back(1);
      return;
    }
    FeaturePoint& mean = means[at];
    const float share = 1.0F / static_cast<float>(++counts_[at]);
    mean.position += share * (point.position - mean.position);
    mean.intensity += share * (point.intensity - mean.intensity);
    mean.offset_s += share * (point.offset_s - mean.offset_s);
    mean.normal += point.normal;
  }

  std::vector<FeaturePoint> means;

 private:
  double per_m_;
  std::vector<int> counts_;
  FlatIndex index_{4096};
};

class Extraction {
 public:
  Extraction(const RingTable& table, const Calibration& calibration)
      : table_(table), range_sigma_(static_cast<float>(calibration.lidar_range_sigma_m)) {
    shapes_.resize(static_cast<std::size_t>(table.size()));
    for (int r = 0; r < table_.ring_count(); ++r) {
      for (int i = table_.ring_begin(r); i < table_.ring_end(r); ++i) shape(i) = measure(r, i);
    }
  }

  std::vector<FeaturePoint> edges() const {
    std::vector<FeaturePoint> edges;
    std::vector<bool> taken(static_cast<std::size_t>(table_.size()), false);
    std::vector<EdgeCandidate> candidates;
    for (int r = 0; r < table_.ring_count(); ++r) {
      Across above(table_, r, 1);
      Across below(table_, r, -1);
      const int begin = table_.ring_begin(r);
      const int count = table_.ring_end(r) - begin;
      for (int s = 0; s < kSectors; ++s) {
        edge_candidates(begin + count * s / kSectors, begin + count * (s + 1) / kSectors, r, above, below, candidates);
        take_strongest(candidates, r, taken, edges);
      }
    }
    return edges;
  }

  /// Onto the edges: to matching, a pole's axis is a line as a crease is.
  void add_poles(std::vector<FeaturePoint>& edges) const {
    for (int r = 0; r < table_.ring_count(); ++r) {
      for (int i = table_.ring_begin(r); i < table_.ring_end(r); i = table_.run_end(i)) {
        const auto pole = pole_of_run(table_, r, i, table_.run_end(i), range_sigma_);
        if (!pole) continue;
        edges.push_back({pole->axis_point, table_.intensity(pole->index), Eigen::Vector3f::Zero(), pole->spread_m,
                         seconds(pole->index), laser(r)});
      }
    }
  }

  std::vector<FeaturePoint> planes() const {
    Cells cells(kPlaneSpacing_m);
    for (int r = 0; r < table_.ring_count(); ++r) {
      Across above(table_, r, 1);
      Across below(table_, r, -1);
      for (int i = table_.ring_begin(r); i < table_.ring_end(r); ++i) {
        if (!is_planar(i)) continue;
        const Eigen::Vector3f normal = normal_at(i, above, below);
        if (normal.isZero()) continue;
        cells.add({table_.position(i), table_.intensity(i), normal, 0.0F, seconds(i), laser(r)});
      }
    }
    for (FeaturePoint& mean : cells.means) mean.normal.normalize();
    return std::move(cells.means);
  }

  std::vector<FeaturePoint> clutter() const {
    Cells cells(kClutterSpacing_m);
    for (int r = 0; r < table_.ring_count(); ++r) {
      for (int i = table_.ring_begin(r); i < table_.ring_end(r); ++i) {
        if (!is_clutter(i, r)) continue;
        const Eigen::Vector3f along_ring = table_.beam(table_.run_end(i)) - table_.beam(table_.run_begin(i) - 1);
        const Eigen::Vector3f across = table_.beam(i).cross(along_ring);
        if (across.isZero()) continue;
        cells.add({table_.position(i), table_.intensity(i), across.normalized(), 0.0F, seconds(i), laser(r)});
      }
    }
    for (FeaturePoint& mean : cells.means) mean.normal.normalize();
    return std::move(cells.means);
  }

 private:
  int laser(int ring) const { return table_.lines_in_turn() ? 0 : ring; }

  /// Walks other rings on one side in step with the one being read, and finds the return beside each of its own.
  class Across {
   public:
    Across(const RingTable& table, int ring, int direction) : table_(table) {
      for (int k = 1, at = ring; k <= kFarthestLine; ++k) {
        at = table.ring_across(at, direction);
        if (at < 0) return;
        if ((k & (k - 1)) != 0) continue;
        walks_.at(static_cast<std::size_t>(count_++)) = {table.ring_begin(at), table.ring_end(at)};
        if (!table.lines_in_turn()) return;
      }
    }
    /// The return of the same firing; of lines in turn, or without times, that of the nearest direction; -1 for none.
    /// Lines in turn meet on the motor's axis: near it, a line further off is read.
    int at(int i) {
      if (!table_.lines_in_turn() && table_.timed()) return count_ > 0 ? of_firing(table_.offset_ns(i)) : -1;
      for (int w = 0; w < count_; ++w) {
        Walk& walk = walks_.at(static_cast<std::size_t>(w));
        while (walk.next + 1 < walk.end && apart(i, walk.next + 1) <= apart(i, walk.next)) ++walk.next;
        if (apart(i, walk.next) >= RingTable::kCrossAngle) return walk.next;
      }
      return -1;
    }

   private:
    static constexpr int kFarthestLine = 8;  // lines 1, 2, 4 and 8 are read
    struct Walk {
      int next = 0;
      int end = 0;
    };

    int of_firing(std::int32_t offset_ns) {
      Walk& walk = walks_.front();
      while (walk.next < walk.end && table_.offset_ns(walk.next) < offset_ns - kFiring_ns) ++walk.next;
      return walk.next < walk.end && table_.offset_ns(walk.next) <= offset_ns + kFiring_ns ? walk.next : -1;
    }
    float apart(int i, int j) const { return (table_.direction(i) - table_.direction(j)).norm(); }

    const RingTable& table_;
    std::array<Walk, 4> walks_{};
    int count_ = 0;
  };

  Shape& shape(int i) { return shapes_[static_cast<std::size_t>(i)]; }
  const Shape& shape(int i) const { return shapes_[static_cast<std::size_t>(i)]; }
  float seconds(int i) const { return 1e-9F * static_cast<float>(table_.offset_ns(i)); }

  int wanted_half_window(int ring, int i) const {
    const float step_m = std::max(1e-3F, table_.beam_spacing(ring) * table_.range(i));
    return std::clamp(static_cast<int>(std::ceil(kHalfWindow_m / step_m)), kLeastHalfWindow, kLargestHalfWindow);
  }

  /// Curvature (5.12), times the range, with two changes. The centre is the mean of a few returns, which cuts its
  /// noise. The part along the surface is left out: uneven spacing of the returns on a slanting wall, not shape, causes
  /// it.
  Shape measure(int ring, int i) const {
    const int room = std::min(i - table_.run_begin(i), table_.run_end(i) - 1 - i);
    const int n = std::min(wanted_half_window(ring, i), room);
    if (n < kLeastHalfWindow) return {};
    const int core = std::max(1, n / 8);
    const Eigen::Vector3f before = table_.mean(i - n, i - 1);
    const Eigen::Vector3f after = table_.mean(i + 1, i + n);
    const Eigen::Vector3f offset = table_.mean(i - core, i + core) - 0.5F * (before + after);
    Shape result;
    result.half_window = n;
    result.tangent = (after - before).normalized();
    result.deviation_m = (offset - offset.dot(result.tangent) * result.tangent).norm();
    result.sigma_m = range_sigma_ / std::sqrt(static_cast<float>(2 * core + 1));
    return result;
  }

  void edge_candidates(int first, int end, int ring, Across& above, Across& below,
                       std::vector<EdgeCandidate>& candidates) const {
    candidates.clear();
    for (int i = first; i < end; ++i) {
      const Shape& s = shape(i);
      if (s.half_window > 0) {
        if (s.deviation_m < std::max(kEdgeCurvature * table_.range(i), kEdgeSigmas * s.sigma_m)) continue;
        if (runs_along_beam(i, above, below)) continue;
        candidates.push_back({i, s.half_window, s.deviation_m / table_.range(i), std::nullopt});
      } else if (is_silhouette(i, ring)) {
        // Ranked by the turn that the unseen side of the step would show: half the least window, at a right angle.
        candidates.push_back(
            {i, kLeastHalfWindow, 0.5F * kLeastHalfWindow * table_.beam_spacing(ring), silhouette_step(i)});
      }
    }
  }

  /// The end of a run where the surface stops in front of something further: a genuine edge. The far side of the same
  /// gap is not: it is where the near surface's shadow falls (thesis 4.1, occlusion).
  bool is_silhouette(int i, int ring) const {
    const bool starts_run = i == table_.run_begin(i);
    const bool ends_run = i + 1 == table_.run_end(i);
    if (starts_run == ends_run || table_.run_end(i) - table_.run_begin(i) < 2 * kLeastHalfWindow) return false;
    const int beyond = starts_run ? i - 1 : i + 1;
    if (beyond < table_.ring_begin(ring) || beyond >= table_.ring_end(ring)) return false;
    if (!table_.adjacent_in_angle(i, beyond) || table_.range(beyond) <= table_.range(i)) return false;
    const int inside = starts_run ? i + kLeastHalfWindow : i - kLeastHalfWindow;
    const Eigen::Vector3f along = (table_.position(inside) - table_.position(i)).normalized();
    if (along.cross(table_.beam(i)).norm() <= kSilhouetteGrazing) return false;
    // Of a trunk the chord may stand across the beam, and still the border seen depends on where it is seen from.
    const int half_window = std::min(wanted_half_window(ring, i), (table_.run_end(i) - table_.run_begin(i) - 1) / 2);
    return !is_round(table_, starts_run ? i + half_window : i - half_window, half_window);
  }

  /// From a silhouette's return to where the next beam, which missed it, passed at the same range.
  Eigen::Vector3f silhouette_step(int i) const {
    const int beyond = i == table_.run_begin(i) ? i - 1 : i + 1;
    return table_.range(i) * (table_.beam(beyond) - table_.beam(i));
  }

  /// Where the same surface steps almost along the beam from ring to ring, a ring bends sharply on a smooth surface
  /// (the floor of a round tunnel): grazing, as much as a wall seen edge-on.
  bool runs_along_beam(int i, Across& above, Across& below) const {
    const Eigen::Vector3f up = step_across(i, above.at(i));
    const Eigen::Vector3f down = step_across(i, below.at(i));
    const auto along = [&](const Eigen::Vector3f& step) {
      return !step.isZero() && step.cross(table_.beam(i)).norm() < kSilhouetteGrazing * step.norm();
    };
    return along(up) || along(down);
  }

  /// Strongest first, none within the window of one already taken.
  void take_strongest(std::vector<EdgeCandidate>& candidates, int ring, std::vector<bool>& taken,
                      std::vector<FeaturePoint>& edges) const {
    std::sort(candidates.begin(), candidates.end(), [](const EdgeCandidate& a, const EdgeCandidate& b) {
      return a.score != b.score ? a.score > b.score : a.index < b.index;
    });
    int left = kEdgesPerSector;
    for (const EdgeCandidate& c : candidates) {
      if (left == 0) break;
      if (taken[static_cast<std::size_t>(c.index)]) continue;
      const std::optional<Eigen::Vector3f> position = edge_position(c);
      if (!position) continue;
      // The edge lies anywhere between two beams: uniform, so a spacing over sqrt(12).
      edges.push_back({*position, table_.intensity(c.index), Eigen::Vector3f::Zero(),
                       0.289F * (c.step ? c.step->norm() : 0.0F), seconds(c.index), laser(ring)});
      const int first = std::max(table_.run_begin(c.index), c.index - c.half_window);
      const int last = std::min(table_.run_end(c.index) - 1, c.index + c.half_window);
      for (int i = first; i <= last; ++i) taken[static_cast<std::size_t>(i)] = true;
      --left;
    }
  }

  /// A crease narrower than the window (a door frame's) shows in half or a quarter of it.
  std::optional<Eigen::Vector3f> edge_position(const EdgeCandidate& c) const {
    if (c.step) return table_.position(c.index) + 0.5F * *c.step;
    std::optional<Eigen::Vector3f> position;
    for (int n = c.half_window; n >= kLeastHalfWindow && !position; n /= 2) {
      position = fit_crease(table_, c.index, n, range_sigma_);
    }
    return position;
  }

  /// Part of a short run with something further, or something nearer, on both sides. (On a wall that the beams graze,
  /// too, every return may be a run of its own, but there the ranges all go one way.)
  bool is_clutter(int i, int ring) const {
    const int before = table_.run_begin(i) - 1;
    const int after = table_.run_end(i);
    if (after - before > 2 * kLeastHalfWindow + 1) return false;
    if (before < table_.ring_begin(ring) || after >= table_.ring_end(ring)) return false;
    return (table_.range(before) > table_.range(i)) == (table_.range(after) > table_.range(i));
  }

  bool is_planar(int i) const {
    const Shape& s = shape(i);
    return s.half_window > 0 && s.deviation_m < std::max(kPlaneCurvature * table_.range(i), kPlaneSigmas * s.sigma_m);
  }

  /// The step to the same surface on another ring, or zero where that ring sees another surface.
  Eigen::Vector3f step_across(int i, int other) const {
    if (other < 0 || shape(other).half_window == 0) return Eigen::Vector3f::Zero();
    const Eigen::Vector3f step = smoothed(other) - smoothed(i);
    const bool near = step.norm() < kCrossLimit * table_.range(i) + kCrossLimit_m;
    return near ? step : Eigen::Vector3f::Zero();
  }

  Eigen::Vector3f smoothed(int i) const {
    const int core = std::max(1, shape(i).half_window / 3);
    return table_.mean(i - core, i + core);
  }

  /// Unit normal towards the sensor from the ring's own tangent and the steps to the rings above and below; zero where
  /// they do not tell one or the beam grazes the surface.
  Eigen::Vector3f normal_at(int i, Across& above, Across& below) const {
    const Eigen::Vector3f up = step_across(i, above.at(i));
    const Eigen::Vector3f down = -step_across(i, below.at(i));
    Eigen::Vector3f across = up + down;
    if (!up.isZero() && !down.isZero() && up.normalized().dot(down.normalized()) < kCrossBend) {
      across = up.norm() < down.norm() ? up : down;  // a crease: the nearer neighbour is likelier on this side of it
    }
    const Eigen::Vector3f normal = shape(i).tangent.cross(across);
    const float length = normal.norm();
    if (length < 0.3F * across.norm() || length <= 0.0F) return Eigen::Vector3f::Zero();
    const float towards = normal.dot(table_.beam(i)) / length;
    if (std::abs(towards) < kGrazing) return Eigen::Vector3f::Zero();
    return (towards > 0.0F ? -1.0F : 1.0F) / length * normal;
  }

  const RingTable& table_;
  float range_sigma_;
  std::vector<Shape> shapes_;
};

}  // namespace

FeatureCloud extract_features(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration) {
  const RingTable table(scan, deskewed, calibration);
  const Extraction extraction(table, calibration);
  FeatureCloud cloud{extraction.edges(), extraction.planes(), extraction.clutter()};
  extraction.add_poles(cloud.edges);
  return cloud;
}

void move(FeatureCloud& features, const Pose& target_from_source, float later_s) {
  const Eigen::Matrix3f rotation = target_from_source.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = target_from_source.translation.cast<float>();
  for (std::vector<FeaturePoint>* kind : {&features.edges, &features.planes, &features.clutter}) {
    for (FeaturePoint& f : *kind) {
      f.position = rotation * f.position + translation;
      f.normal = rotation * f.normal;
      f.offset_s += later_s;
    }
  }
}

}  // namespace plumbline
