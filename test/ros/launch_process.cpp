// SPDX-License-Identifier: BSD-3-Clause
#include "ros/launch_process.hpp"

#include <fcntl.h>
#include <ros/init.h>
#include <ros/time.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace edgevox::test {
namespace {

[[noreturn]] void become(std::vector<char*>& arguments, int in, int out) {
  ::prctl(PR_SET_PDEATHSIG, SIGINT);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  ::execvp(arguments.front(), arguments.data());
  ::_exit(127);
}

}  // namespace

bool waitFor(const std::function<bool()>& condition, double seconds) {
  const ros::WallTime until = ros::WallTime::now() + ros::WallDuration(seconds);
  while (!condition()) {
    if (!ros::ok() || ros::WallTime::now() > until) return false;
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  return true;
}

Process::Process(const std::vector<std::string>& command, const std::filesystem::path& folder,
                 const std::filesystem::path& log) {
  // A shell sets PWD as well.
  std::vector<std::string> words = {"sh", "-c", "cd \"$0\" && export PWD && exec \"$@\"", folder};
  words.insert(words.end(), command.begin(), command.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int in = ::open("/dev/null", O_RDONLY);
  pid_ = ::fork();
  if (pid_ == 0) become(arguments, in, out);
  ::close(in);
  ::close(out);
  if (pid_ < 0) throw std::runtime_error("cannot start " + command.front());
}

Process::~Process() {
  interrupt();
  const ros::WallTime until = ros::WallTime::now() + ros::WallDuration(30);
  while (!hasEnded() && ros::WallTime::now() < until) ros::WallDuration(0.05).sleep();
  if (hasEnded()) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Process::interrupt() {
  if (!exit_code_) ::kill(pid_, SIGINT);
}

bool Process::waitForEnd(double seconds) {
  return waitFor([this] { return hasEnded(); }, seconds);
}

bool Process::hasEnded() {
  if (exit_code_) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return true;
}

}  // namespace edgevox::test
