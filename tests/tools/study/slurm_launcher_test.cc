#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <list>
#include <thread>

#include "tests/tools/program_fixture.h"
#include "tools/study/child_process.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A port that was free a moment ago.
int free_port() {
  const int socket_file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  const bool found = socket_file >= 0 && bind(socket_file, any, size) == 0 && getsockname(socket_file, any, &size) == 0;
  close(socket_file);
  return found ? ntohs(address.sin_port) : 0;
}

std::string host_name() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

/// A cluster of one node on the loopback, with its own key, sockets, ports and state. Its daemons are children that die
/// with this process, however it dies.
class Cluster {
 public:
  explicit Cluster(const fs::path& root) : root_(root) {
    fs::create_directories(root / "state");
    fs::create_directories(root / "spool");
    std::ofstream(root / "munge.key") << std::string(64, 'k') << getpid();
    chmod((root / "munge.key").c_str(), 0600);
    write_configuration();
    setenv("SLURM_CONF", (root / "slurm.conf").c_str(), 1);
    const std::string at = root.string();
    // --force: a scratch directory may be writable for more than munged likes.
    start({"munged", "--foreground", "--force", "--key-file=" + at + "/munge.key", "--socket=" + at + "/munge.socket",
           "--pid-file=" + at + "/munged.pid", "--log-file=" + at + "/munged.log", "--seed-file=" + at + "/munged.seed",
           "--num-threads=2"});
    wait_until([&] { return fs::exists(root_ / "munge.socket"); }, "munged");
    start({"slurmctld", "-D", "-i"});
    start({"slurmd", "-D", "-N", "node"});
    wait_until([] { return std::system("sinfo --noheader --states=idle 2>/dev/null | grep -q idle") == 0; }, "slurmd");
  }
  ~Cluster() {
    // In an orderly way, so that helpers of theirs end too. Whatever is left after that is killed, munged last.
    [[maybe_unused]] const int status =
        std::system("scancel --user=$(id -un) >/dev/null 2>&1; scontrol shutdown >/dev/null 2>&1");
    const auto has_ended = [](ChildProcess& process) { return process.poll().has_value(); };
    for (int i = 0; i < 50 && daemons_.size() > 1; ++i) {
      daemons_.remove_if(has_ended);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    while (!daemons_.empty()) daemons_.pop_back();
    unsetenv("SLURM_CONF");
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

 private:
  void write_configuration() const {
    const std::string at = root_.string();
    const std::string host = host_name();
    std::ofstream(root_ / "slurm.conf")
        << "ClusterName=test\nSlurmctldHost=" << host << "(127.0.0.1)\n"
        << "AuthType=auth/munge\nCredType=cred/munge\nAuthInfo=socket=" << at << "/munge.socket\n"
        << "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
        << "SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\n"
        << "SwitchType=switch/none\nMpiDefault=none\nJobAcctGatherType=jobacct_gather/none\n"
        << "AccountingStorageType=accounting_storage/none\nReturnToService=2\n"
        << "SlurmUser=" << getuid() << "\nSlurmdUser=" << getuid() << "\n"
        << "SlurmctldPort=" << free_port() << "\nSlurmdPort=" << free_port() << "\n"
        << "StateSaveLocation=" << at << "/state\nSlurmdSpoolDir=" << at << "/spool\n"
        << "SlurmctldPidFile=" << at << "/slurmctld.pid\nSlurmdPidFile=" << at << "/slurmd.pid\n"
        << "SlurmctldLogFile=" << at << "/slurmctld.log\nSlurmdLogFile=" << at << "/slurmd.log\n"
        << "SlurmdParameters=config_overrides\n"
        << "NodeName=node NodeHostname=" << host << " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n"
        << "PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP\n";
  }
  void start(const std::vector<std::string>& command) { daemons_.emplace_back(command, RunLimits{600.0, 8192.0}); }

  void wait_until(const std::function<bool()>& ready, const std::string& daemon) {
    for (int i = 0; i < 600 && !ready(); ++i) {
      for (ChildProcess& process : daemons_) {
        if (const auto end = process.poll()) throw std::runtime_error(daemon + " ended: " + end->output);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    if (!ready()) throw std::runtime_error(daemon + " does not answer");
  }

  fs::path root_;
  std::list<ChildProcess> daemons_;
};

class SlurmLauncher : public ProgramFixture {
 protected:
  SlurmLauncher() {
    directory_.write("base.yaml", kShortScenario);
    // One estimator that works and one that fails at once, which costs little and must fail alike everywhere.
    directory_.write("sweep.yaml", "scenario: base.yaml\nestimators: [exec:/bin/false, imu]\n");
  }
};

TEST_F(SlurmLauncher, AJobArrayMakesTheTableThatWeMakeHere) {
  const Cluster cluster(directory_.path() / "cluster");
  ASSERT_EQ(call("sweep sweep.yaml --out array --launcher slurm --jobs 2"), 0)
      << content("said.txt") << content("array/slurm/1.log") << content("cluster/slurmctld.log");
  EXPECT_THAT(content("array/slurm/2.log"), HasSubstr("1 of 2 runs made")) << "each run by a task of its own";
  EXPECT_FALSE(fs::exists(directory_.path() / "array/slurm/1")) << "the shards are merged and gone";
  EXPECT_TRUE(fs::exists(directory_.path() / "array/runs/0001/report.html"));
  const std::string table = content("array/table.csv");
  ASSERT_EQ(call("sweep sweep.yaml --out here --jobs 1"), 0) << content("said.txt");
  EXPECT_EQ(table, content("here/table.csv"));
  EXPECT_EQ(content("array/table.jsonl"), content("here/table.jsonl"));

  // Nothing is left to do, so nothing is submitted.
  ASSERT_EQ(call("sweep sweep.yaml --out array --launcher slurm --resume"), 0) << content("said.txt");
  EXPECT_EQ(content("array/table.csv"), table);
}

/// Slurm as this test has it: submits by running the tasks one after the other, of which the second fails at first.
constexpr const char* kSbatch = R"sh(#!/bin/sh
[ "$1" = --version ] && exit 0
case "$*" in *--array=1-2*) tasks="1 2" ;; *--array=2*) tasks="2" ;; *) echo "sbatch: error: unexpected: $*" >&2; exit 1 ;; esac
echo "sbatch: a word of the site's" >&2
echo "$*" >> submitted.txt
for last; do :; done
for task in $tasks; do
  [ $task = 2 ] && [ ! -e second.txt ] && { touch second.txt; continue; }
  SLURM_ARRAY_TASK_ID=$task sh "$last" >/dev/null 2>&1
done
echo "77;site"
)sh";

TEST_F(SlurmLauncher, WhatATaskLeftUndoneIsSaidAndResumed) {
  for (const auto& [name, text] : {std::pair("bin/sbatch", kSbatch),
                                   std::pair("bin/squeue", "#!/bin/sh\necho 'Invalid job id specified' >&2; exit 1\n"),
                                   std::pair("bin/scancel", "#!/bin/sh\n")}) {
    fs::create_directories(directory_.path() / "bin");
    fs::permissions(directory_.write(name, text), fs::perms::owner_all);
  }
  directory_.write("sweep.yaml", "scenario: base.yaml\nestimators: [exec:/bin/false]\nseeds: 2\n");
  const std::string path = "PATH='" + directory_.path().string() + "/bin':$PATH";
  EXPECT_EQ(call("sweep sweep.yaml --launcher slurm --out out", path), 3);
  EXPECT_THAT(content("said.txt"), HasSubstr("not all tasks of job 77 did their work"));
  EXPECT_THAT(content("said.txt"), HasSubstr("1 of 2 runs made"));
  EXPECT_EQ(call("sweep sweep.yaml --launcher slurm --out out --resume", path), 0) << content("said.txt");
  EXPECT_THAT(content("submitted.txt"), HasSubstr("--array=2 ")) << "only what was missing";
  EXPECT_THAT(content("said.txt"), HasSubstr("2 of 2 runs made"));
}

TEST_F(SlurmLauncher, WithoutSlurmItSaysSo) {
  EXPECT_EQ(call("sweep sweep.yaml --out a --launcher pbs"), 2);
  EXPECT_EQ(call("sweep sweep.yaml --out a --launcher slurm --shard 1/2"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("makes its own shards"));
  EXPECT_EQ(call("sweep sweep.yaml --out a --launcher slurm", "PATH=/nowhere"), 2);
  EXPECT_THAT(content("said.txt"), HasSubstr("sbatch failed: the program cannot be executed"));
  EXPECT_FALSE(fs::exists(directory_.path() / "a"));
}

}  // namespace
}  // namespace plumbline
