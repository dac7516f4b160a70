// SPDX-License-Identifier: BSD-3-Clause
// Bags written by ChunkedBag have the same content as bags written by rosbag.
#include "aquafarm_sim/bags/chunked_bag.h"

#include <diagnostic_msgs/KeyValue.h>
#include <gtest/gtest.h>
#include <nav_msgs/OccupancyGrid.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <system_error>
#include <tuple>

#include "aquafarm_sim/bags/bag_structure.h"

namespace aquafarm_sim::test {
namespace {

namespace fs = std::filesystem;

class ChunkedBagTest : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("chunked_bag_") + test.name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = (folder_ / "x.bag").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  std::string path_;
};

/// Writes messages of two topics, about 2 MB that lz4 cannot compress, and thus several chunks.
template <typename Write>
void WriteMessages(const Write& write) {
  std::mt19937 rng(1);
  nav_msgs::OccupancyGrid grid;
  diagnostic_msgs::KeyValue word;
  for (std::uint32_t i = 1; i <= 1000; ++i) {
    word.key = std::to_string(i);
    write("/ranch/word", ros::Time(i, 5), word);
    if (i % 10 != 0) continue;
    grid.data.resize(20'000 + i);
    for (auto& cell : grid.data) cell = static_cast<std::int8_t>(rng());
    write("/ranch/grid", ros::Time(i, 6), grid);
  }
}

using Entry =
    std::tuple<std::string, ros::Time, std::string, std::string, std::string, std::string>;

std::vector<Entry> Read(const std::string& path) {
  std::vector<Entry> entries;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    entries.emplace_back(message.getTopic(), message.getTime(), message.getDataType(),
                         message.getMD5Sum(), message.getMessageDefinition(), bytes);
  }
  return entries;
}

TEST_F(ChunkedBagTest, HoldsWhatRosbagsWriterDoes) {
  ChunkedBag ours(path_);
  WriteMessages([&](const auto&... message) { ours.Write(message...); });
  ours.Close();
  const std::string reference_path = (folder_ / "reference.bag").string();
  rosbag::Bag reference(reference_path, rosbag::bagmode::Write);
  WriteMessages([&](const auto&... message) { reference.write(message...); });
  reference.close();
  EXPECT_NO_THROW(internal::CheckStructure(path_));
  const std::vector<Entry> entries = Read(path_);
  EXPECT_EQ(1100U, entries.size());
  EXPECT_TRUE(entries == Read(reference_path));
  EXPECT_GE(rosbag::View(rosbag::Bag(path_)).getBeginTime(), ros::Time(1, 5));
}

TEST_F(ChunkedBagTest, CanBeAppendedTo) {
  ChunkedBag ours(path_);
  WriteMessages([&](const auto&... message) { ours.Write(message...); });
  ours.Close();
  rosbag::Bag more(path_, rosbag::bagmode::Append);
  more.write("/ranch/word", ros::Time(2000), diagnostic_msgs::KeyValue());
  more.close();
  EXPECT_NO_THROW(internal::CheckStructure(path_));
  EXPECT_EQ(1101U, Read(path_).size());
}

TEST_F(ChunkedBagTest, AMessageMayBeLargerThanAChunkAndItsBlocks) {
  nav_msgs::OccupancyGrid grid;
  grid.data.resize(5'000'000);
  std::mt19937 rng(1);
  for (auto& cell : grid.data) cell = static_cast<std::int8_t>(rng());
  ChunkedBag ours(path_);
  ours.Write("/ranch/grid", ros::Time(1), grid);
  ours.Write("/ranch/grid", ros::Time(1), grid);
  ours.Close();
  EXPECT_NO_THROW(internal::CheckStructure(path_));
  const rosbag::Bag bag(path_);
  rosbag::View view(bag);
  ASSERT_EQ(2U, view.size());
  EXPECT_TRUE(view.begin()->instantiate<nav_msgs::OccupancyGrid>()->data == grid.data);
}

TEST_F(ChunkedBagTest, RefusesWhatItsReadersCouldNotTake) {
  ChunkedBag ours(path_);
  nav_msgs::OccupancyGrid grid;
  ours.Write("/ranch/grid", ros::Time(2), grid);
  EXPECT_THROW(ours.Write("/ranch/grid", ros::Time(1), grid), std::invalid_argument);
  grid.data.resize(std::size_t{256} << 20U);
  EXPECT_THROW(ours.Write("/ranch/grid", ros::Time(3), grid), std::length_error);
  ours.Close();
  EXPECT_NO_THROW(internal::CheckStructure(path_));
  EXPECT_EQ(1U, Read(path_).size());
}

TEST_F(ChunkedBagTest, WithoutMessagesItIsAnEmptyBag) {
  ChunkedBag(path_).Close();
  EXPECT_NO_THROW(internal::CheckStructure(path_));
  EXPECT_TRUE(Read(path_).empty());
}

TEST_F(ChunkedBagTest, WhatWasNotClosedIsReindexed) {
  {
    ChunkedBag ours(path_);
    WriteMessages([&](const auto&... message) { ours.Write(message...); });
  }
  EXPECT_GT(fs::file_size(path_), 1'000'000U);  // complete chunks are on disk
  EXPECT_THROW(rosbag::Bag{path_}, rosbag::BagUnindexedException);
  ASSERT_EQ(0, std::system(("rosbag reindex -q " + path_).c_str()));
  const std::size_t whole = Read(path_).size();
  EXPECT_GT(whole, 900U);
  EXPECT_LT(whole, 1100U);
}

TEST_F(ChunkedBagTest, SaysWhyItCannotBeWritten) {
  const auto error_of = [](const std::string& path) {
    try {
      ChunkedBag bag(path);
      bag.Close();
    } catch (const std::system_error& error) {
      return error.code();
    }
    return std::error_code();
  };
  EXPECT_EQ(std::errc::no_such_file_or_directory, error_of((folder_ / "no/x.bag").string()));
  EXPECT_EQ(std::errc::no_space_on_device, error_of("/dev/full"));
}

}  // namespace
}  // namespace aquafarm_sim::test
