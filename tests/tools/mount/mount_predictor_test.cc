#include "tools/mount/mount_predictor.h"

#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

Scenario scenario_of(const TemporaryDirectory& directory, const std::string& world, const std::string& rig = "") {
  const auto path = directory.write("walk.yaml", world +
                                                     "\nmotion: {rest_s: 0.5, waypoints: [[-4, 0, 1.5], [0, 0, 1.5], "
                                                     "[4, 0, 1.5]]}\n" +
                                                     rig);
  return load_scenario(path, {}, {});
}

TEST(MountPredictor, SeesThatATunnelsAxisIsDegenerateAndARoomsIsNot) {
  const TemporaryDirectory directory;
  const Scenario tunnel = scenario_of(directory, "world: {scene: tunnel}");
  const MountPrediction in_tunnel = MountPredictor(tunnel, {}).predict(tunnel.rig);
  EXPECT_DOUBLE_EQ(in_tunnel.degenerate_time, 1.0);
  EXPECT_GT(in_tunnel.worst_direction, 3.0);
  EXPECT_GT(in_tunnel.overlap, 0.3);
  EXPECT_DOUBLE_EQ(in_tunnel.own_body_share, 0.0);

  const Scenario room = scenario_of(directory, "world: {scene: dark_room}");
  const MountPrediction in_room = MountPredictor(room, {}).predict(room.rig);
  EXPECT_DOUBLE_EQ(in_room.degenerate_time, 0.0);
  EXPECT_LT(in_room.worst_direction, 0.5);
  EXPECT_LT(in_room.drift_percent, in_tunnel.drift_percent);
}

TEST(MountPredictor, GivesTheSameFiguresAgainAndOthersForAnotherAngle) {
  const TemporaryDirectory directory;
  const Scenario level = scenario_of(directory, "world: {scene: corridor}");
  const Scenario down = scenario_of(directory, "world: {scene: corridor}", "rig: {pitch_deg: 90}");
  MountPredictor predictor(level, {});
  const MountPrediction first = predictor.predict(level.rig);
  const MountPrediction other = predictor.predict(down.rig);
  const MountPrediction again = predictor.predict(level.rig);
  EXPECT_EQ(first.drift_percent, again.drift_percent);
  EXPECT_EQ(first.coverage, again.coverage);
  EXPECT_NE(first.drift_percent, other.drift_percent);
  const MountView view = predictor.view(down.rig);
  // Straight down in the middle of the image is the floor, less the pack's own height away.
  const std::size_t middle =
      static_cast<std::size_t>(view.camera.width * (view.camera.height / 2) + view.camera.width / 2);
  EXPECT_NEAR(view.camera.range_m[middle], 1.4, 0.2);
}

TEST(MountPredictor, RefusesASurfaceThatTheSceneDoesNotHave) {
  const TemporaryDirectory directory;
  EXPECT_THROW(MountPredictor(scenario_of(directory, "world: {scene: corridor}"), {"cheese"}), InputError);
}

}  // namespace
}  // namespace plumbline
