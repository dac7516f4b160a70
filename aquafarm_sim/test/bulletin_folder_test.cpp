// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/bulletin_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "aquafarm/base/check.h"

namespace aquafarm_sim {
namespace {

namespace fs = std::filesystem;

class BulletinFolderTest : public testing::Test {
 protected:
  BulletinFolderTest()
      : path_(fs::temp_directory_path() / ("bulletins." + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~BulletinFolderTest() override { fs::remove_all(path_); }

  // Sets the time explicitly because the clock may be coarse.
  void Write(const std::string& name, const std::string& text, int seconds) const {
    std::ofstream(path_ / name) << text;
    fs::last_write_time(path_ / name, fs::file_time_type(std::chrono::seconds(1000 + seconds)));
  }
  std::string Path(const std::string& name) const { return (path_ / name).string(); }

  const fs::path path_;
};

using Files = std::vector<std::string>;

Files Take(BulletinFolder& folder) {
  Files files = folder.New();
  for (const std::string& file : files) folder.Mark(file);
  return files;
}

TEST_F(BulletinFolderTest, GivesEachFileOnceTheOldestFirst) {
  BulletinFolder folder(path_.string());
  EXPECT_EQ(Take(folder), Files{});
  Write("b.json", "1", 2);
  Write("c.json", "1", 1);
  EXPECT_EQ(Take(folder), (Files{Path("c.json"), Path("b.json")}));
  EXPECT_EQ(Take(folder), Files{});
}

TEST_F(BulletinFolderTest, GivesAFileAgainWhenItChanged) {
  BulletinFolder folder(path_.string());
  Write("b.json", "1", 2);
  Take(folder);
  Write("b.json", "2", 3);
  EXPECT_EQ(Take(folder), Files{Path("b.json")});
  fs::remove(path_ / "b.json");
  EXPECT_EQ(Take(folder), Files{});
  Write("b.json", "2", 3);
  EXPECT_EQ(Take(folder), Files{Path("b.json")}) << "it was gone between";
}

TEST_F(BulletinFolderTest, GivesAFileUntilItIsMarked) {
  BulletinFolder folder(path_.string());
  Write("b.json", "1", 2);
  EXPECT_EQ(folder.New(), Files{Path("b.json")});
  EXPECT_EQ(folder.New(), Files{Path("b.json")}) << "the ranch was away";
  Write("b.json", "22", 3);
  folder.Mark(Path("b.json"));
  EXPECT_EQ(folder.New(), Files{Path("b.json")}) << "changed after the look";
  folder.Mark(Path("b.json"));
  EXPECT_EQ(folder.New(), Files{});
}

TEST_F(BulletinFolderTest, PassesOverWhatIsBeingWritten) {
  BulletinFolder folder(path_.string());
  Write("b.json.part", "1", 1);
  Write(".b.json", "1", 1);
  fs::create_directories(path_ / "folder");
  EXPECT_EQ(Take(folder), Files{});
}

TEST_F(BulletinFolderTest, IsRefusedWhereThereIsNone) {
  BulletinFolder folder(Path("nowhere"));
  try {
    Take(folder);
    FAIL();
  } catch (const aquafarm::InputError& error) {
    EXPECT_EQ(error.what(),
              Path("nowhere") + ": cannot read this folder: No such file or directory");
  }
}

}  // namespace
}  // namespace aquafarm_sim
