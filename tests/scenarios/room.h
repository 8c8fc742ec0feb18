#pragma once

namespace plumbline {

/// A room of 16 m by 16 m with walls of 4 m, under open sky; a scenario names the file that it is written to.
inline constexpr char kRoom[] = R"(<mujoco>
  <worldbody>
    <geom type="box" pos="0 0 -0.1" size="8 8 0.1"/>
    <geom type="box" pos="8 0 2" size="0.1 8 2"/>
    <geom type="box" pos="-8 0 2" size="0.1 8 2"/>
    <geom type="box" pos="0 8 2" size="8 0.1 2"/>
    <geom type="box" pos="0 -8 2" size="8 0.1 2"/>
  </worldbody>
</mujoco>
)";

}  // namespace plumbline
