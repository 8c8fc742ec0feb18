#include "sim/scenes/cars.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A car's side view, from nose (x > 0) to tail.
struct CarShape {
  double length = 4.3;
  double width = 1.76;
  double belt = 0.9;  // height of the bonnet and of the windows' lower edge
  double roof = 1.45;
  double screen_foot = 0.9, screen_top = 0.25;  // x of the windscreen
  double rear_top = -1.1, rear_foot = -1.7;     // x of the rear window
  double wheel = 0.31;
};

CarShape draw_shape(RandomStream& stream) {
  CarShape shape;
  const double kind = stream.uniform();
  if (kind < 0.30) {  // saloon
    shape = {4.6, 1.78, 0.92, 1.43, 0.95, 0.25, -1.05, -1.65, 0.31};
  } else if (kind < 0.60) {  // hatchback
    shape = {4.0, 1.72, 0.92, 1.48, 0.95, 0.35, -1.45, -1.85, 0.30};
  } else if (kind < 0.80) {  // estate, off-roader
    shape = {4.6, 1.84, 1.02, 1.68, 1.05, 0.45, -1.95, -2.15, 0.35};
  } else {  // van
    shape = {5.0, 1.92, 1.15, 2.15, 1.75, 1.25, -2.40, -2.44, 0.34};
  }
  const double scale = stream.uniform(0.96, 1.03);
  shape.length *= scale;
  shape.roof *= stream.uniform(0.97, 1.04);
  return shape;
}

/// The cabin narrows towards its roof: a frustum of four sides and the roof.
void add_cabin(Scenery& scenery, const std::string& paint, const CarShape& car, const Pose& frame) {
  const double low = 0.5 * car.width - 0.06;
  const double high = 0.5 * car.width - 0.22;
  const auto at = [&](double x, double y, double z) { return frame * Vector3d(x, y, z); };
  const double top = car.roof;
  const double belt = car.belt;
  scenery.quad(paint, at(car.rear_top, -high, top), at(car.screen_top, -high, top), at(car.screen_top, high, top),
               at(car.rear_top, high, top));
  scenery.quad("glass", at(car.screen_foot, -low, belt), at(car.screen_foot, low, belt), at(car.screen_top, high, top),
               at(car.screen_top, -high, top));
  scenery.quad("glass", at(car.rear_foot, low, belt), at(car.rear_foot, -low, belt), at(car.rear_top, -high, top),
               at(car.rear_top, high, top));
  for (const double side : {-1.0, 1.0}) {
    // Windows between pillars of the paint.
    const double span = car.screen_top - car.rear_top;
    const double cuts[] = {0.0, 0.06, 0.48, 0.54, 0.94, 1.0};
    for (int i = 0; i < 5; ++i) {
      const auto foot = [&](double t) {
        return at(car.rear_foot + t * (car.screen_foot - car.rear_foot), side * low, belt);
      };
      const auto head = [&](double t) { return at(car.rear_top + t * span, side * high, top); };
      const std::string& material = i % 2 == 0 ? paint : std::string("glass");
      if (side < 0.0) {
        scenery.quad(material, foot(cuts[i]), foot(cuts[i + 1]), head(cuts[i + 1]), head(cuts[i]));
      } else {
        scenery.quad(material, foot(cuts[i + 1]), foot(cuts[i]), head(cuts[i]), head(cuts[i + 1]));
      }
    }
  }
}

void add_wheel(Scenery& scenery, const Pose& frame, double x, double y, double radius) {
  constexpr int kSides = 8;
  constexpr double kHalfTread_m = 0.11;
  std::vector<Vector2d> disc;
  std::vector<Vector2d> hub;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    const Vector2d out(std::cos(angle), std::sin(angle));
    disc.emplace_back(Vector2d(x, radius) + radius * out);
    hub.emplace_back(Vector2d(x, radius) + 0.55 * radius * out);
  }
  scenery.prism("rubber", disc, y - kHalfTread_m, y + kHalfTread_m, frame);
  scenery.prism("steel", hub, y - kHalfTread_m - 0.01, y + kHalfTread_m + 0.01, frame);
}

}  // namespace

void add_parked_car(Scenery& scenery, RandomStream& stream, const Pose& world_from_car) {
  const CarShape car = draw_shape(stream);
  const std::string paint = pick(stream, car_paints());
  const double nose = 0.5 * car.length;
  const double half = 0.5 * car.width;
  const std::vector<Vector2d> body = {
      {-nose, 0.38},       {-nose + 0.15, 0.2},         {nose - 0.15, 0.2},        {nose, 0.38},
      {nose - 0.05, 0.72}, {car.screen_foot, car.belt}, {car.rear_foot, car.belt}, {-nose + 0.02, car.belt - 0.06}};
  scenery.prism(paint, body, -half, half, world_from_car);
  add_cabin(scenery, paint, car, world_from_car);
  for (const double x : {0.6 * nose, -0.6 * nose}) {
    for (const double y : {-half + 0.1, half - 0.1}) add_wheel(scenery, world_from_car, x, y, car.wheel);
  }
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (half - 0.3);
    scenery.box("lamp_glass", {nose - 0.09, y - 0.18, 0.58}, {nose + 0.02, y + 0.18, 0.72}, world_from_car);
    scenery.box("sign_red", {-nose - 0.02, y - 0.15, 0.62}, {-nose + 0.04, y + 0.15, 0.8}, world_from_car);
  }
  scenery.box("sign_white", {-nose - 0.03, -0.26, 0.45}, {-nose + 0.02, 0.26, 0.56}, world_from_car);
}

void add_moving_car(MjcfWriter& writer, RandomStream& stream, const std::string& body_name) {
  const CarShape car = draw_shape(stream);
  const std::string paint = pick(stream, car_paints());
  const double nose = 0.5 * car.length;
  const double half = 0.5 * car.width;
  writer.begin_body(body_name);
  writer.box(paint, {-nose, -half, 0.22}, {nose, half, 0.72});
  writer.box(paint, {-nose + 0.06, -half + 0.02, 0.72}, {car.screen_foot, half - 0.02, car.belt});
  const double inset = 0.14;
  writer.box("glass", {car.rear_foot + 0.12, -half + inset, car.belt},
             {car.screen_foot - 0.3, half - inset, car.roof - 0.1});
  writer.box(paint, {car.rear_top - 0.05, -half + inset - 0.03, car.roof - 0.1},
             {car.screen_top + 0.05, half - inset + 0.03, car.roof});
  for (const double x : {car.screen_foot - 0.35, 0.5 * (car.screen_foot + car.rear_foot)}) {
    writer.box(paint, {x - 0.05, -half + inset - 0.02, car.belt}, {x + 0.05, half - inset + 0.02, car.roof - 0.1});
  }
  for (const double x : {0.6 * nose, -0.6 * nose}) {
    for (const double side : {-1.0, 1.0}) {
      writer.cylinder("rubber", {x, side * (half - 0.18), car.wheel}, {x, side * (half + 0.02), car.wheel}, car.wheel);
    }
  }
  writer.box("sign_white", {-nose - 0.02, -0.26, 0.45}, {-nose + 0.02, 0.26, 0.56});
  writer.end_body();
}

}  // namespace plumbline
