#include "sim/scenes/parked_things.h"

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

// Several draws in one expression stand in braces only: those are evaluated from left to right.

// A little askew, as people park: 3 degrees turn the ends of a car by 11 cm.
Pose askew(RandomStream& stream, const Pose& world_from_bay) {
  const double yaw = stream.uniform(-0.05, 0.05);
  return world_from_bay * upright_frame({stream.uniform(-0.1, 0.1), stream.uniform(-0.1, 0.1), 0.0}, yaw);
}

void add_axle(MjcfWriter& writer, const Pose& frame, double y, double half_width) {
  writer.cylinder("rubber", {-half_width, y, 0.32}, {half_width, y, 0.32}, 0.32, frame);
}

void add_car(MjcfWriter& writer, RandomStream& stream, const Pose& frame) {
  const double half_length = stream.uniform(1.85, 2.1);
  const double half_width = stream.uniform(0.80, 0.88);
  const double roof = stream.uniform(1.35, 1.6);
  const std::string paint = pick(stream, vehicle_materials());
  writer.box(paint, {-half_width, -half_length, 0.25}, {half_width, half_length, 0.85}, frame);
  if (stream.uniform() < 0.5) {
    writer.box(paint, {-half_width + 0.1, -0.9, 0.85}, {half_width - 0.1, 1.3, roof}, frame);
  } else {
    writer.ellipsoid(paint, {0.0, 0.1, 0.8}, {half_width - 0.05, 1.5, roof - 0.8}, frame);
  }
  add_axle(writer, frame, -0.62 * half_length, half_width + 0.02);
  add_axle(writer, frame, 0.62 * half_length, half_width + 0.02);
}

void add_van(MjcfWriter& writer, RandomStream& stream, const Pose& frame) {
  const double roof = stream.uniform(1.85, 2.15);
  const std::string paint = pick(stream, vehicle_materials());
  writer.box(paint, {-0.95, -2.1, 0.3}, {0.95, 1.3, roof}, frame);
  writer.box(paint, {-0.95, 1.3, 0.3}, {0.95, 2.1, 1.1}, frame);
  add_axle(writer, frame, -1.3, 0.97);
  add_axle(writer, frame, 1.3, 0.97);
}

void add_tank(MjcfWriter& writer, RandomStream& stream, const Pose& frame) {
  const double radius = stream.uniform(0.5, 0.8);
  const double half_length = stream.uniform(0.8, 1.2);
  const double middle = radius + 0.35;
  writer.capsule(pick(stream, barrel_materials()), {0.0, -half_length, middle}, {0.0, half_length, middle}, radius,
                 frame);
  for (const double y : {-0.7 * half_length, 0.7 * half_length}) {
    writer.box("concrete_grey", {-0.6, y - 0.15, 0.0}, {0.6, y + 0.15, 0.5}, frame);
  }
}

void add_barrels(MjcfWriter& writer, RandomStream& stream, const Pose& frame) {
  const int count = stream.integer(2, 4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d foot(i % 2 == 0 ? -0.45 : 0.45, i < 2 ? -0.5 : 0.6, 0.0);
    const double tall = stream.uniform(0.8, 1.1);
    const double radius = stream.uniform(0.26, 0.34);
    const Eigen::Vector3d jitter{stream.uniform(-0.1, 0.1), stream.uniform(-0.15, 0.15), 0.0};
    writer.cylinder(pick(stream, barrel_materials()), foot + jitter, foot + jitter + tall * Eigen::Vector3d::UnitZ(),
                    radius, frame);
  }
}

}  // namespace

void add_crates(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_stack, double height_limit_m) {
  const int count = stream.integer(1, 3);
  double bottom = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d half{stream.uniform(0.3, 0.5), stream.uniform(0.3, 0.5), stream.uniform(0.25, 0.45)};
    const Pose crate = world_from_stack * upright_frame({0.0, 0.0, bottom + half.z()}, stream.uniform(-0.4, 0.4));
    const std::string material = pick(stream, crate_materials());
    bottom += 2.0 * half.z();
    if (bottom > height_limit_m) return;
    writer.box(material, -half, half, crate);
  }
}

void add_parked_thing(MjcfWriter& writer, RandomStream& stream, const Pose& world_from_bay) {
  const Pose frame = askew(stream, world_from_bay);
  const double kind = stream.uniform();
  if (kind < 0.40) {
    add_car(writer, stream, frame);
  } else if (kind < 0.55) {
    add_van(writer, stream, frame);
  } else if (kind < 0.67) {
    add_tank(writer, stream, frame);
  } else if (kind < 0.85) {
    for (const double y : {-1.1, 1.1}) {
      add_crates(writer, stream, frame * upright_frame({stream.uniform(-0.3, 0.3), y, 0.0}, 0.0), 2.2);
    }
  } else {
    add_barrels(writer, stream, frame);
  }
}

}  // namespace plumbline
