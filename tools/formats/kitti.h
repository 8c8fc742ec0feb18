#pragma once

#include "tools/formats/dataset.h"

/// KITTI's folders: those of a raw drive (velodyne_points/, image_00/, oxts/, calibration beside or above), of an
/// odometry sequence (velodyne/, image_0/, times.txt, calib.txt, poses.txt or ../../poses/NN.txt), or scans and images
/// that lie loose in one folder. Scans are .bin or .pcd.
///
/// What is written is an odometry sequence, with what that cannot say in files of its own, which are read where they
/// are: calibration.yaml; scans.txt ("start_s end_s sweep ends_sweep" of every scan); times/NNNNNN.bin (float32 seconds
/// since the scan's start, of every point) and rings/NNNNNN.bin (uint16); image_0_times.txt and image_1_times.txt (a
/// camera has its own rate); imu.txt ("t wx wy wz ax ay az"). times.txt and poses.txt are of the middles of the sweeps,
/// as KITTI's; the poses are camera 0's.
namespace plumbline {

Dataset open_kitti(const std::filesystem::path& path, const DatasetSettings& settings);

std::unique_ptr<DatasetWriter> make_kitti_writer(const std::filesystem::path& directory,
                                                 const Calibration& calibration);

}  // namespace plumbline
