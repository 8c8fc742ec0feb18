#include "sim/polygon_cut.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {
namespace {

/// Where an edge meets the plane x[axis] = position; the same for both directions of the edge.
Eigen::Vector3d crossing(Eigen::Vector3d a, Eigen::Vector3d b, int axis, double position) {
  if (a[axis] > b[axis]) std::swap(a, b);
  Eigen::Vector3d point = a + (position - a[axis]) / (b[axis] - a[axis]) * (b - a);
  point[axis] = position;
  return point;
}

/// The parts of a polygon below and above a plane.
std::pair<Polygon, Polygon> split(const Polygon& polygon, int axis, double position) {
  std::pair<Polygon, Polygon> parts;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& here = polygon[i];
    const Eigen::Vector3d& next = polygon[(i + 1) % polygon.size()];
    if (here[axis] <= position) parts.first.push_back(here);
    if (here[axis] >= position) parts.second.push_back(here);
    if ((here[axis] - position) * (next[axis] - position) < 0.0) {
      const Eigen::Vector3d corner = crossing(here, next, axis, position);
      parts.first.push_back(corner);
      parts.second.push_back(corner);
    }
  }
  return parts;
}

void cut_along(int axis, Polygon polygon, Eigen::Vector3i cell, double cell_m, const CellVisitor& visit) {
  if (polygon.size() < 3) return;
  if (axis == 3) {
    visit(cell, polygon);
    return;
  }
  const auto [low, high] = std::minmax_element(polygon.begin(), polygon.end(),
                                               [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  const int first = static_cast<int>(std::floor((*low)[axis] / cell_m));
  const int last = std::max(first, static_cast<int>(std::ceil((*high)[axis] / cell_m)) - 1);
  for (int k = first; k < last; ++k) {
    auto [below, above] = split(polygon, axis, (k + 1) * cell_m);
    cell[axis] = k;
    cut_along(axis + 1, std::move(below), cell, cell_m, visit);
    polygon = std::move(above);
  }
  cell[axis] = last;
  cut_along(axis + 1, std::move(polygon), cell, cell_m, visit);
}

}  // namespace

void cut_into_cells(const Polygon& polygon, double cell_m, const CellVisitor& visit) {
  cut_along(0, polygon, Eigen::Vector3i::Zero(), cell_m, visit);
}

void clip_to_plan(const Eigen::AlignedBox2d& plan, Polygon& polygon) {
  for (int axis = 0; axis < 2; ++axis) {
    polygon = split(polygon, axis, plan.min()[axis]).second;
    polygon = split(polygon, axis, plan.max()[axis]).first;
  }
}

}  // namespace plumbline
