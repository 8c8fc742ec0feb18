#pragma once

#include "tools/formats/ros_messages.h"

namespace plumbline {

/// A cloud as a scan. Point times are read as drivers write them: integers are nanoseconds, floats seconds, since the
/// header's stamp, or absolute if they are beyond a million seconds; fields `time`, `t`, `timestamp`, `time_stamp`,
/// `offset_time`. Rings: `ring`, `channel`, `line`, or the row of an organised cloud. The scan ends with its last
/// point. Points that are not finite or more than 2 s off are dropped.
/// @throws std::invalid_argument for a cloud whose sizes do not agree, or without x, y, z or rings
LidarScan scan_of(const RosPointCloud& cloud);

/// x, y, z, intensity (float32), t (uint32 ns since the header's stamp), ring (uint16).
RosPointCloud cloud_of(const LidarScan& scan);

/// mono8, 8UC1, rgb8, bgr8, rgba8, bgra8. @throws std::invalid_argument for other encodings or sizes that do not agree
CameraFrame frame_of(const RosImage& image, int camera_id);
/// 16UC1 (millimetres), mono16 likewise, or 32FC1 (metres). @throws std::invalid_argument
DepthFrame depth_of(const RosImage& image, int camera_id);

RosImage image_of(const CameraFrame& frame);  ///< mono8
RosImage image_of(const DepthFrame& frame);   ///< 32FC1

}  // namespace plumbline
