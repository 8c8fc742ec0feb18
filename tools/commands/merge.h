#pragma once

#include <string>
#include <vector>

namespace plumbline {

struct MergeArguments {
  std::vector<std::string> sources;
  std::string out;
};

/// Brings the shards of a sweep together and writes its tables and report. @returns the exit code
int merge_shards(const MergeArguments& arguments);

}  // namespace plumbline
