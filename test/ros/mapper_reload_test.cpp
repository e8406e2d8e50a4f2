// SPDX-License-Identifier: BSD-3-Clause
// edgevox/Mapper unloaded in the midst of its work, and loaded again.
#include <fcntl.h>
#include <std_srvs/Trigger.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <thread>

#include "ros/mapper_fixture.hpp"
#include "support/temp_folder.hpp"

namespace edgevox::test {
namespace {

/// A call of save_map that does not end before this does: its folder is locked.
class LongSave {
 public:
  explicit LongSave(const std::string& service)
      : descriptor_(::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY)) {
    EXPECT_EQ(0, ::flock(descriptor_, LOCK_EX));
    caller_ = std::thread([this, service] {
      SaveMap save;
      save.request.folder = folder_.path().string();
      callService(service, save);
    });
  }
  ~LongSave() {
    ::close(descriptor_);
    caller_.join();
  }

  /// Whether somebody waits for the lock.
  bool begun() const {
    struct stat folder {};
    if (::fstat(descriptor_, &folder) != 0) return false;
    const std::string inode = ":" + std::to_string(folder.st_ino) + " ";
    return eventually([&] {
      std::ifstream locks("/proc/locks");
      for (std::string line; std::getline(locks, line);) {
        if (hasWords(line, {"->", "FLOCK", inode})) return true;
      }
      return false;
    });
  }

 private:
  TempFolder folder_;
  int descriptor_;
  std::thread caller_;
};

using ReloadTest = MapperTest;

TEST_F(ReloadTest, OffersItsServicesOnceTheOneBeforeHasEnded) {
  start();
  map(firstScans(3));
  {
    const LongSave save(resolved("save_map"));
    ASSERT_TRUE(save.begun());
    ASSERT_TRUE(unload("mapper"));
    const ros::WallTime before = ros::WallTime::now();
    ASSERT_TRUE(load("mapper"));
    EXPECT_LT((ros::WallTime::now() - before).toSec(), 5.0);
    EXPECT_TRUE(logs(rosgraph_msgs::Log::WARN,
                     {"not offered yet", resolved("save_map"), resolved("reset")}));
    EXPECT_TRUE(tells("mapper", Status::WARN, {"not offered yet", resolved("reset")}));
  }
  EXPECT_TRUE(eventually(
      [&] { return !hasWords(statusesOf("mapper").back().message, {"not offered yet"}); }));
  EXPECT_TRUE(eventually([&] {
    std_srvs::Trigger reset;
    return callService(resolved("reset"), reset) && reset.response.success;
  }));
  map(firstScans(3));
  EXPECT_EQ("first", statusOf(3));
  const TempFolder folder;
  EXPECT_TRUE(save(folder.path().string()).success);
  EXPECT_EQ(0U, countLogged(rosgraph_msgs::Log::ERROR, {"already advertised"}));
}

}  // namespace
}  // namespace edgevox::test

int main(int argc, char** argv) { return edgevox::test::runNodeletTests(argc, argv); }
