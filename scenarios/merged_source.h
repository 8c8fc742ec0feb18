#pragma once

#include "scenarios/sensor_link.h"

namespace plumbline {

/// Two sources as one, in order of delivery; the first goes first at one time. Each may be asked one message ahead.
MessageSource merged_sources(MessageSource first, MessageSource second);

}  // namespace plumbline
