#include "tools/commands/merge_maps.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <string_view>

#include "estimator/localization/map_merger.h"
#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"
#include "tools/formats/point_cloud_file.h"
#include "tools/output/atomic_file.h"
#include "tools/report/merge_picture.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint8_t, 3> kOfA{40, 120, 200};
constexpr std::array<std::uint8_t, 3> kOfB{240, 140, 40};

Pose guess_of(const MergeMapsArguments& arguments) {
  if (arguments.start.empty()) return {};
  const auto& s = arguments.start;
  return {rotation_from_rpy({0.0, 0.0, s[3] * std::numbers::pi / 180.0}), {s[0], s[1], s[2]}};
}

std::vector<MapPoint> moved(std::vector<MapPoint> points, const Pose& target_from_source) {
  const Eigen::Matrix3f rotation = target_from_source.rotation.toRotationMatrix().cast<float>();
  for (MapPoint& point : points) {
    point.position = (target_from_source * point.position.cast<double>().eval()).cast<float>();
    point.normal = rotation * point.normal;
  }
  return points;
}

bool has_normals(const std::vector<MapPoint>& points) {
  return std::any_of(points.begin(), points.end(), [](const MapPoint& p) { return !p.normal.isZero(); });
}

/// Both, each in its colour. Normals of one alone would make edges of the other's points.
std::vector<MapPoint> joined(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  const bool keep_normals = has_normals(a) && has_normals(b);
  std::vector<MapPoint> all;
  all.reserve(a.size() + b.size());
  const auto append = [&](const std::vector<MapPoint>& points, const std::array<std::uint8_t, 3>& colour) {
    for (MapPoint point : points) {
      point.coloured = true;
      point.colour = colour;
      if (!keep_normals) point.normal.setZero();
      all.push_back(point);
    }
  };
  append(a, kOfA);
  append(b, kOfB);
  return all;
}

void write_whole(const fs::path& path, const std::vector<MapPoint>& points) {
  fs::path staging = path;
  staging += ".partial-" + std::to_string(getpid());
  try {
    write_ply(staging.string(), points);
    fs::rename(staging, path);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove(staging, ignored);
    throw InputError(path.string() + ": cannot be written");
  }
}

void print(const MapAlignment& m) {
  const double degrees = 180.0 / std::numbers::pi;
  std::cout << "  overlap     " << readable_text(100.0 * m.overlap) << " % of B near A, "
            << readable_text(100.0 * m.close_share) << " % of that on it, " << readable_text(100.0 * m.support)
            << " % borne out in the worst direction\n"
            << "  residuals   " << readable_text(m.residual_median_m) << " m median, "
            << readable_text(m.residual_p95_m) << " m p95\n"
            << "  correction  " << readable_text(m.correction_m) << " m, " << readable_text(degrees * m.correction_rad)
            << "°\n"
            << "  other fits  " << readable_text(m.spread_m) << " m aside\n";
}

}  // namespace

int merge_maps(const MergeMapsArguments& arguments) {
  const fs::path out = arguments.out;
  if (out.extension() != ".ply")
    throw InputError("--out: found '" + arguments.out + "'; allowed is a name ending in .ply");
  const PriorMap a = read_prior_map(arguments.a).map;
  const PriorMap b = read_prior_map(arguments.b).map;
  const MapAlignment alignment = align_maps(a, b, guess_of(arguments));
  print(alignment);
  if (!alignment.refusal.empty()) {
    std::cerr << "plumbline: " << arguments.b << " on " << arguments.a << ": " << alignment.refusal << std::endl;
    return kExitCheckFailed;
  }
  const std::vector<MapPoint> b_in_a = moved(b.thinned, alignment.a_from_b);
  const std::vector<std::uint8_t> png = merge_picture(a.thinned, b_in_a);
  const fs::path picture = fs::path(out).replace_extension(".png");
  write_whole(out, joined(a.thinned, b_in_a));
  write_file_atomically(picture, {reinterpret_cast<const char*>(png.data()), png.size()});
  std::cout << out.string() << ": " << a.thinned.size() << " points of A and " << b_in_a.size() << " of B\n";
  std::cout << "  picture     " << picture.string() << std::endl;
  return kExitDone;
}

void add_merge_maps_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<MergeMapsArguments>();
  CLI::App* verb = app.add_subcommand("merge-maps", "Align a map with another where they overlap, and join them");
  verb->footer("Exit code 1, and nothing written, if the overlap does not bear the alignment out.");
  verb->add_option("A", arguments->a, "map whose frame stays, PLY or PCD")->required();
  verb->add_option("B", arguments->b, "map that is moved")->required();
  verb->add_option("--out", arguments->out, "joined map, NAME.ply; its picture is NAME.png")->required();
  verb->add_option("--b-start", arguments->start,
                   "X Y Z YAW_DEG: where B's origin lies in A, to a metre and 10 degrees")
      ->expected(4)
      ->check(CLI::Range(-1e4, 1e4));
  verb->callback([arguments, &chosen] { chosen = [arguments] { return merge_maps(*arguments); }; });
}

}  // namespace plumbline
