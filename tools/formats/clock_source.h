#pragma once

#include "scenarios/sensor_link.h"

namespace plumbline {

/// Adds the clock that stands in for an IMU where a recording has none: ImuSamples of zeros at a rate, from a quarter
/// of a second before the first message on, and one at every message's time, behind the message, so that an estimator's
/// answer to the message has its output there.
MessageSource with_clock(MessageSource messages, double rate_hz);

}  // namespace plumbline
