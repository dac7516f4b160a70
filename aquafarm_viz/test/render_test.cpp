// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "fixture.h"

namespace aquafarm_viz {
namespace {

namespace fs = std::filesystem;

struct Result {
  int code{};
  std::string output;
};

Result Render(const std::string& arguments) {
  const std::string command = std::string(RENDER) + " " + arguments + " 2>&1";
  Result result;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) result.output += part.data();
  result.code = pclose(pipe);
  return result;
}

class RenderTest : public testing::Test {
 protected:
  RenderTest() : folder_(fs::temp_directory_path() / ("render_test_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~RenderTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  // Episodes 12 and 13 with steps 0 to 9, on topics with the prefixes.
  std::string MakeBag(const std::vector<std::string>& prefixes) {
    const std::string path = Path("farm.bag");
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    double seconds = 1.0;
    for (const auto& prefix : prefixes) {
      for (std::uint64_t episode : {12U, 13U}) {
        auto spec = test::MakeSpec();
        spec.episode = episode;
        bag.write(prefix + "spec", ros::Time(seconds += 0.1), spec);
        for (std::uint64_t step = 0; step < 10; ++step) {
          auto state = test::MakeState();
          state.episode = episode;
          state.step = step;
          state.terminated = step == 9;
          bag.write(prefix + "state", ros::Time(seconds += 0.1), state);
        }
      }
    }
    return path;
  }

  fs::path folder_;
};

TEST_F(RenderTest, WritesTheStepAskedForInTheSizeAskedFor) {
  const std::string bag = MakeBag({"/aquafarm/"});
  const Result result =
      Render("--bag " + bag + " --step 7 --width 640 --height 480 -o " + Path("x.png"));
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_EQ(cv::imread(Path("x.png")).size(), cv::Size(640, 480));
}

TEST_F(RenderTest, TellsEpisodesApartAndFindsTheEnd) {
  const std::string bag = MakeBag({""});
  EXPECT_EQ(Render("--bag " + bag + " --end -o " + Path("a.png")).code, 0);
  EXPECT_EQ(Render("--bag " + bag + " --end --episode 13 -o " + Path("b.png")).code, 0);
  EXPECT_GT(cv::norm(cv::imread(Path("a.png")), cv::imread(Path("b.png"))), 0.0);
}

TEST_F(RenderTest, SaysWhatTheBagHasWhenTheStepIsMissing) {
  const std::string bag = MakeBag({"/aquafarm/"});
  const Result result = Render("--bag " + bag + " --step 99 -o " + Path("x.png"));
  EXPECT_NE(result.code, 0);
  EXPECT_NE(result.output.find("no such step; the bag has episodes 12 to 13 and steps up to 9"),
            std::string::npos)
      << result.output;
}

TEST_F(RenderTest, AsksWhichRanchWhenThereAreSeveral) {
  const std::string bag = MakeBag({"/east/", "/west/"});
  const Result result = Render("--bag " + bag + " -o " + Path("x.png"));
  EXPECT_NE(result.code, 0);
  EXPECT_NE(result.output.find("choose one with --ns: /east/ /west/"), std::string::npos)
      << result.output;
  EXPECT_EQ(Render("--bag " + bag + " --ns /west -o " + Path("x.png")).code, 0);
}

TEST_F(RenderTest, RefusesWhatIsNoBagOrNoPlaceToWrite) {
  EXPECT_NE(Render("--bag " + Path("none.bag")).code, 0);
  const std::string bag = MakeBag({"/aquafarm/"});
  const Result unwritable = Render("--bag " + bag + " -o " + Path("no/such/folder/x.png"));
  EXPECT_NE(unwritable.code, 0);
  EXPECT_NE(unwritable.output.find("could not be written"), std::string::npos);
  const Result unknown = Render("--bag " + bag + " -o " + Path("x.nonsense"));
  EXPECT_NE(unknown.code, 0);
  EXPECT_EQ(unknown.output.substr(0, 8), "render: ");
}

}  // namespace
}  // namespace aquafarm_viz
