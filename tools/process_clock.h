#pragma once

namespace plumbline {

/// Seconds since the kernel started this process, loading of libraries included.
double seconds_since_process_start();

}  // namespace plumbline
