#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

namespace plumbline::test {

/// The way-points that scenario files use in the scenes with their default measures.
struct SceneRoute {
  std::string scene;
  std::vector<Eigen::Vector3d> waypoints;
};

inline std::vector<SceneRoute> scene_routes() {
  return {
      {"garage", {{6, 4.75, 1.5},    {12, 4.75, 1.5},  {18, 4.75, 1.5},  {24, 4.75, 1.5},    {29.8, 4.75, 1.5},
                  {31.9, 4.1, 1.5},  {32.5, 2, 1.5},   {32.5, -2, 1.5},  {33.1, -4.1, 1.5},  {35, -4.75, 1.5},
                  {38, -4.75, 1.5},  {45, -4.75, 1.5}, {52, -4.75, 1.5}, {59, -4.75, 1.5},   {65.7, -4.75, 1.5},
                  {68.1, -4.1, 1.5}, {68.7, -2, 1.5},  {68.7, 2, 1.5},   {69.3, 4.1, 1.5},   {71.2, 4.75, 1.5},
                  {74, 4.75, 1.5},   {81, 4.75, 1.5},  {88, 4.75, 1.5},  {95, 4.75, 1.5},    {102, 4.75, 1.5},
                  {104.3, 4.1, 1.5}, {104.9, 2, 1.5},  {104.9, -2, 1.5}, {104.3, -4.1, 1.5}, {102, -4.75, 1.5},
                  {98, -4.75, 1.5}}},
      {"corridor",
       {{1.5, 0, 1.5},   {5, 0, 1.5},         {9, 0, 1.5},     {13, 0, 1.5},    {16.5, 0, 1.5},      {18.3, 0, 1.5},
        {19.5, 0, 1.5},  {20.56, 0.44, 1.5},  {21, 1.5, 1.5},  {21, 2.7, 1.5},  {21, 4.5, 1.5},      {21, 8, 1.5},
        {21, 12.5, 1.5}, {21, 16.5, 1.5},     {21, 18.3, 1.5}, {21, 19.5, 1.5}, {21.44, 20.56, 1.5}, {22.5, 21, 1.5},
        {23.7, 21, 1.5}, {25.5, 21, 1.5},     {29, 21, 1.5},   {33.5, 21, 1.5}, {37.5, 21, 1.5},     {39.3, 21, 1.5},
        {40.5, 21, 1.5}, {41.56, 21.44, 1.5}, {42, 22.5, 1.5}, {42, 23.7, 1.5}, {42, 25.5, 1.5},     {42, 29, 1.5},
        {42, 33, 1.5},   {42, 37, 1.5},       {42, 40.5, 1.5}}},
      {"tunnel", {{-33, 0, 1.5}, {-22, 0, 1.5}, {-11, 0, 1.5}, {0, 0, 1.5}, {11, 0, 1.5}, {22, 0, 1.5}, {33, 0, 1.5}}},
      {"hall",
       {{0, 0, 6.26},          {3.36, 4.25, 6.64},  {6.5, 7.36, 6.94},    {9.19, 8.5, 7.13},    {11.26, 7.36, 7.2},
        {12.56, 4.25, 7.15},   {13, 0, 6.98},       {12.56, -4.25, 6.7},  {11.26, -7.36, 6.34}, {9.19, -8.5, 5.91},
        {6.5, -7.36, 5.44},    {3.36, -4.25, 4.98}, {0, 0, 4.54},         {-3.36, 4.25, 4.16},  {-6.5, 7.36, 3.86},
        {-9.19, 8.5, 3.67},    {-11.26, 7.36, 3.6}, {-12.56, 4.25, 3.65}, {-13, 0, 3.82},       {-12.56, -4.25, 4.1},
        {-11.26, -7.36, 4.46}, {-9.19, -8.5, 4.89}, {-6.5, -7.36, 5.36},  {-3.36, -4.25, 5.82}, {0, 0, 6.26}}},
  };
}

inline SceneRoute route_of(const std::string& scene) {
  for (const SceneRoute& route : scene_routes()) {
    if (route.scene == scene) return route;
  }
  return {};
}

/// Points along a Catmull-Rom spline through the way-points: smooth as a walker's path, and so a little off the
/// polyline.
inline std::vector<Eigen::Vector3d> points_along(const std::vector<Eigen::Vector3d>& waypoints, double spacing_m) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Eigen::Vector3d& a = waypoints[i == 0 ? 0 : i - 1];
    const Eigen::Vector3d& b = waypoints[i];
    const Eigen::Vector3d& c = waypoints[i + 1];
    const Eigen::Vector3d& d = waypoints[std::min(i + 2, waypoints.size() - 1)];
    // Tangents by the non-uniform (chord-length) rule, so that unequal gaps do not overshoot.
    const double h0 = std::max((b - a).norm(), 1e-9);
    const double h1 = (c - b).norm();
    const double h2 = std::max((d - c).norm(), 1e-9);
    const Eigen::Vector3d slope = (c - b) / h1;
    const Eigen::Vector3d m1 = i == 0 ? slope : Eigen::Vector3d((h1 * (b - a) / h0 + h0 * slope) / (h0 + h1));
    const Eigen::Vector3d m2 =
        i + 2 == waypoints.size() ? slope : Eigen::Vector3d((h2 * slope + h1 * (d - c) / h2) / (h1 + h2));
    const int steps = std::max(1, static_cast<int>(h1 / spacing_m));
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const double t2 = t * t;
      const double t3 = t2 * t;
      points.push_back((2 * t3 - 3 * t2 + 1) * b + (t3 - 2 * t2 + t) * h1 * m1 + (3 * t2 - 2 * t3) * c +
                       (t3 - t2) * h1 * m2);
    }
  }
  points.push_back(waypoints.back());
  return points;
}

}  // namespace plumbline::test
