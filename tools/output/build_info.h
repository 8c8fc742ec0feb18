#pragma once

namespace plumbline {

extern const char* const kVersion;
/// What was built, read at every build; ends with "-dirty" where it was not as committed. Empty without git.
extern const char* const kGitCommit;

}  // namespace plumbline
