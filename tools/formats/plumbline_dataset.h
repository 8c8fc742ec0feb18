#pragma once

#include "tools/formats/dataset.h"

/// Our own format, which loses nothing: messages.plb, a message stream (tools/formats/message_stream.h),
/// calibration.yaml, a copy of its calibration for people, and ground_truth.tum.
namespace plumbline {

/// @param path  the folder, or a message stream by itself
Dataset open_plumbline_dataset(const std::filesystem::path& path, const DatasetSettings& settings);

std::unique_ptr<DatasetWriter> make_plumbline_writer(const std::filesystem::path& directory,
                                                     const Calibration& calibration);

}  // namespace plumbline
