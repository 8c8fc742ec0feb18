#pragma once

namespace plumbline {

constexpr double squared(double x) { return x * x; }

}  // namespace plumbline
