#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// The commands of the Slurm workload manager (sbatch, squeue, scancel), for one job array.
namespace plumbline {

/// What to submit. Partition, account, memory and time limit are the user's matter: sbatch takes them from SBATCH_...
/// variables.
struct SlurmArray {
  std::string name;
  std::filesystem::path script;       ///< a shell script, told its index by $SLURM_ARRAY_TASK_ID
  std::vector<std::size_t> indices;   ///< ascending
  std::filesystem::path log_pattern;  ///< %a stands for the index
};

/// @throws InputError if Slurm's commands cannot be executed here
void require_slurm();

/// @returns the job's id
/// @throws InputError with sbatch's words if it refuses
std::string submit(const SlurmArray& array);

/// Whether any task of a job waits or runs. A controller that does not answer is asked again for some minutes.
/// @throws InputError with squeue's words if it keeps failing
bool is_queued(const std::string& job);

/// Ends all tasks; one that has ended already is none.
void cancel(const std::string& job);

/// 1, 2, 3, 7 as "1-3,7".
std::string index_ranges(const std::vector<std::size_t>& indices);

}  // namespace plumbline
