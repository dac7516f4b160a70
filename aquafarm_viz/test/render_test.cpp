// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "aquafarm/base/version.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

namespace fs = std::filesystem;

struct Result {
  int code{};
  std::string output;
};

Result Render(const std::string& arguments, const std::string& environment = "") {
  const std::string command = environment + " " + std::string(RENDER) + " " + arguments + " 2>&1";
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

  // Writes episodes 12 and 13 with steps 0 to 9, on topics with the given prefixes.
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

TEST_F(RenderTest, LeavesThePanelOut) {
  const std::string size = "--bag " + MakeBag({""}) + " --width 640 --height 480 -o ";
  EXPECT_EQ(Render(size + Path("with.png")).code, 0);
  EXPECT_EQ(Render(size + Path("without.png") + " --no-panel").code, 0);
  const cv::Mat without = cv::imread(Path("without.png"));
  EXPECT_EQ(without.size(), cv::Size(640, 480));
  EXPECT_GT(cv::norm(without, cv::imread(Path("with.png"))), 1000.0);
}

TEST_F(RenderTest, DistinguishesEpisodesAndFindsTheEnd) {
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
  EXPECT_NE(result.output.find("select one with --ns: /east/ /west/"), std::string::npos)
      << result.output;
  EXPECT_EQ(Render("--bag " + bag + " --ns /west -o " + Path("x.png")).code, 0);
}

TEST_F(RenderTest, RefusesInvalidBagsAndUnwritablePaths) {
  const Result none = Render("--bag " + Path("none.bag"));
  EXPECT_EQ(WEXITSTATUS(none.code), 2);
  EXPECT_EQ(none.output, "render: " + Path("none.bag") + ": no such file\n");
  EXPECT_EQ(Render("--bag " + Path("")).output,
            "render: " + Path("") + ": damaged or not a bag: not a regular file\n");
  const std::string bag = MakeBag({"/aquafarm/"});
  test::DamageIndex(bag);
  const Result damaged = Render("--bag " + bag + " -o " + Path("x.png"));
  EXPECT_EQ(WEXITSTATUS(damaged.code), 2);
  EXPECT_EQ(damaged.output.find("render: " + bag +
                                ": damaged: an index that does not match its chunk at byte"),
            0U)
      << damaged.output;
  MakeBag({"/aquafarm/"});
  const Result unwritable = Render("--bag " + bag + " -o " + Path("no/such/folder/x.png"));
  EXPECT_EQ(WEXITSTATUS(unwritable.code), 3);
  EXPECT_EQ(WEXITSTATUS(Render("--bag " + bag + " -o " + Path("no/such/folder/x.gif")).code), 3);
  EXPECT_EQ(WEXITSTATUS(Render("--bag " + bag + " --fps fast").code), 2);
  EXPECT_EQ(WEXITSTATUS(Render("--help").code), 0);
  EXPECT_NE(unwritable.output.find("could not be written"), std::string::npos);
  const Result unknown = Render("--bag " + bag + " -o " + Path("x.nonsense"));
  EXPECT_NE(unknown.code, 0);
  EXPECT_EQ(unknown.output, "render: " + Path("x.nonsense") +
                                ": got an unknown extension, expected .png, "
                                ".jpg, .mp4, .webm or .gif\n");
}

TEST_F(RenderTest, PutsSeveralStepsOfOneEpisodeSideBySide) {
  const std::string bag = MakeBag({"/aquafarm/"});
  const Result both =
      Render(bag + " --step 2 --step 8 --width 320 --height 240 -o " + Path("x.png"));
  EXPECT_EQ(both.code, 0) << both.output;
  const Result one = Render(bag + " --step 8 --width 320 --height 240 -o " + Path("y.png"));
  EXPECT_EQ(one.code, 0) << one.output;
  const cv::Mat picture = cv::imread(Path("x.png"));
  constexpr int kGutter = 6;
  ASSERT_EQ(picture.size(), cv::Size(640 + kGutter, 240));
  EXPECT_EQ(cv::norm(picture.colRange(320 + kGutter, 640 + kGutter), cv::imread(Path("y.png"))),
            0.0);
}

// Returns the pictures of a video, decoded as by a player.
std::vector<cv::Mat> Pictures(const std::string& path) {
  cv::VideoCapture video(path, cv::CAP_FFMPEG);
  std::vector<cv::Mat> pictures;
  for (cv::Mat picture; video.read(picture);) pictures.push_back(picture.clone());
  return pictures;
}

TEST_F(RenderTest, MakesAVideoOfOneEpisode) {
  const std::string bag = MakeBag({"/aquafarm/"});
  ASSERT_EQ(Render(bag + " --step 4 --width 320 --height 240 -o " + Path("four.png")).code, 0);
  const cv::Mat four = cv::imread(Path("four.png"));
  for (const char* ending : {".mp4", ".webm", ".gif"}) {
    const std::string path = Path(std::string("video") + ending);
    const Result result = Render(bag + " --width 321 --height 241 --fps 5 -o " + path);
    ASSERT_EQ(result.code, 0) << result.output;
    const std::vector<cv::Mat> pictures = Pictures(path);
    ASSERT_NEAR(double(pictures.size()), 20.0, 1.0) << ending;  // ten steps, then two seconds
    ASSERT_EQ(pictures[4].size(), cv::Size(320, 240)) << ending;
    EXPECT_LT(cv::norm(pictures[4], four, cv::NORM_L1) / double(four.total() * 3), 12.0) << ending;
  }
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  }
}

TEST_F(RenderTest, AVideoThatTheDiskHasNoRoomForLeavesNothing) {
  const std::string bag = MakeBag({"/aquafarm/"});
  for (const char* ending : {".mp4", ".webm", ".gif"}) {
    const std::string path = Path(std::string("full") + ending);
    const Result result = Render(bag + " -o " + path, "trap '' XFSZ; ulimit -f 4;");
    EXPECT_EQ(WEXITSTATUS(result.code), 3) << ending << result.output;
    EXPECT_NE(result.output.find(path + ": could not be written"), std::string::npos)
        << result.output;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
      << "the bag";
}

TEST_F(RenderTest, AVideoShowsAWholeEpisode) {
  const std::string bag = MakeBag({"/aquafarm/"});
  EXPECT_NE(Render(bag + " --step 3 -o " + Path("x.gif"))
                .output.find(
                    "render: --step: expected no value with a video, which shows a whole episode"),
            std::string::npos);
  EXPECT_NE(
      Render(bag + " --end -o " + Path("x.gif")).output.find("render: --end: expected no value"),
      std::string::npos);
  EXPECT_FALSE(fs::exists(Path("x.gif")));
}

TEST_F(RenderTest, SaysWhatTheBagLacks) {
  const std::string bag = Path("gap.bag");
  using Steps = std::vector<std::uint64_t>;
  const auto write = [&](bool with_spec, const char* version, const Steps& steps = {0, 1, 4, 5}) {
    rosbag::Bag out(bag, rosbag::bagmode::Write);
    auto spec = test::MakeSpec();
    spec.version = version;
    if (with_spec) out.write("/aquafarm/spec", ros::Time(1), spec);
    for (const std::uint64_t step : steps) {
      auto state = test::MakeState();
      state.step = step;
      state.terminated = step == 5;
      out.write("/aquafarm/state", ros::Time(2 + step), state);
    }
  };
  write(true, aquafarm::kVersion);
  Result result = Render(bag + " --end -o " + Path("x.png"));
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_EQ(result.output, "render: " + bag + ": 2 steps are missing; 'verify' names the first\n");
  result = Render(bag + " --step 4 --step 2 -o " + Path("z.png"));
  EXPECT_EQ(WEXITSTATUS(result.code), 2);
  EXPECT_EQ(result.output, "render: " + bag +
                               ": no step 2; episode 12 has steps 1 and 4 around it; run "
                               "'verify' for details\n");
  write(true, aquafarm::kVersion, {2, 3, 5});
  EXPECT_EQ(
      Render(bag + " -o " + Path("z.png")).output,
      "render: " + bag + ": no step 0; episode 12 begins with step 2; run 'verify' for details\n");
  EXPECT_EQ(Render(bag + " --end -o " + Path("x.png")).output,
            "render: " + bag + ": 1 step is missing; 'verify' names it\n");
  write(true, "9.9.9");
  result = Render(bag + " -o " + Path("x.png"));
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.output.find("recorded by version 9.9.9, this is "), std::string::npos);
  write(true, "");
  result = Render(bag + " -o " + Path("x.png"));
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.output.find(": recorded by an unnamed version, this is "), std::string::npos);
  write(false, "");
  result = Render(bag + " -o " + Path("y.png"));
  EXPECT_NE(result.output.find("no topic spec, so it is unknown what was played; record spec and"),
            std::string::npos)
      << result.output;
}

TEST_F(RenderTest, ASpecThatCannotBeDrawnHasItsLineWithTheBag) {
  const std::string bag = Path("odd.bag");
  const auto output_with = [&](const auto& spec) {
    {
      rosbag::Bag out(bag, rosbag::bagmode::Write);
      out.write("/aquafarm/spec", ros::Time(1), spec);
      out.write("/aquafarm/state", ros::Time(2), test::MakeState());
    }
    const Result result = Render(bag + " -o " + Path("x.png"));
    EXPECT_EQ(WEXITSTATUS(result.code), 2);
    return result.output;
  };
  auto spec = test::MakeSpec();
  spec.width = -1;
  EXPECT_EQ(output_with(spec), "render: " + bag + ": spec.width: got -1, expected [1, 4096]\n");
  EXPECT_EQ(output_with(test::MakeChoice()),
            "render: " + bag +
                ": topic /aquafarm/spec: got type aquafarm_msgs/PolicyChoice, expected "
                "aquafarm_msgs/FarmSpec; record spec and state, as record.launch does\n");
}

TEST_F(RenderTest, AVideoMayLeaveStepsOut) {
  const std::string bag = MakeBag({"/aquafarm/"});
  ASSERT_EQ(
      Render(bag + " --episode 13 --every 4 --fps 1 --width 160 --height 160 -o " + Path("x.gif"))
          .code,
      0);
  EXPECT_NEAR(double(Pictures(Path("x.gif")).size()), 6.0, 1.0);  // steps 0, 4, 8, 9, then two more
}

TEST_F(RenderTest, WithoutACodecItSaysWhatElseThereIs) {
  const std::string bag = MakeBag({"/aquafarm/"});
  const Result result = Render(bag + " -o " + Path("x.mp4"), "OPENCV_VIDEOIO_PRIORITY_FFMPEG=0");
  EXPECT_NE(result.code, 0);
  EXPECT_NE(result.output.find("x.mp4: no codec for .mp4 (tried avc1), or the folder is "
                               "not writable; use .gif, or install libavcodec"),
            std::string::npos)
      << result.output;
  EXPECT_FALSE(fs::exists(Path("x.mp4")));
  const Result layers = Render(bag + " --layers rain -o " + Path("y.png"));
  EXPECT_NE(layers.code, 0);
  EXPECT_NE(layers.output.find("render: layers: got 'rain', expected some of: trail, risk, route, "
                               "sight, values, moves, directions, labels, sea:NAME; or none"),
            std::string::npos);
  const Result gif = Render(bag + " -o " + Path("no/such/folder/x.gif"));
  EXPECT_NE(gif.code, 0);
  EXPECT_NE(gif.output.find("x.gif: could not be written"), std::string::npos) << gif.output;
}

TEST_F(RenderTest, DrawsTheValuesThatABagHoldsAndSaysWhereThereAreNone) {
  const std::string plain = MakeBag({"/aquafarm/"});
  const std::string valued = Path("valued.bag");
  fs::copy_file(plain, valued);
  {
    rosbag::Bag bag(valued, rosbag::bagmode::Append);
    bag.write("/aquafarm/values/points", ros::Time(1.0), test::MakeCloud());
  }
  const std::string layers = " --step 5 --layers values,moves -o ";
  const Result without = Render(plain + layers + Path("plain.png"));
  EXPECT_EQ(without.code, 0);
  EXPECT_NE(without.output.find("no topic values/points, so layers values and moves are left out"),
            std::string::npos)
      << without.output;
  const Result with = Render(valued + layers + Path("valued.png"));
  EXPECT_EQ(with.code, 0);
  EXPECT_EQ(with.output, "");
  EXPECT_GT(cv::norm(cv::imread(Path("plain.png")), cv::imread(Path("valued.png")), cv::NORM_L1),
            1e6);
}

}  // namespace
}  // namespace aquafarm_viz
