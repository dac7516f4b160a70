// SPDX-License-Identifier: BSD-3-Clause
#include "draw/free_space.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace aquafarm_viz {

FreeSpace::FreeSpace(cv::Size size)
    : used_(std::max(1, size.height / kBlock), std::max(1, size.width / kBlock), std::uint8_t{0}),
      size_(size) {}

cv::Rect FreeSpace::Blocks(cv::Rect part) const {
  const cv::Point low(part.x / kBlock, part.y / kBlock);
  const cv::Point high((part.x + part.width - 1) / kBlock + 1,
                       (part.y + part.height - 1) / kBlock + 1);
  return cv::Rect(low, high) & cv::Rect({0, 0}, used_.size());
}

void FreeSpace::Block(cv::Rect part) {
  part &= cv::Rect({0, 0}, size_);
  if (!part.empty()) used_(Blocks(part)) = 1;
}

void FreeSpace::BlockLine(cv::Point2d from, cv::Point2d to, int width) {
  constexpr int kMaxSquares = 500;
  const int count =
      std::clamp(static_cast<int>(std::ceil(cv::norm(to - from) / width)), 1, kMaxSquares);
  for (int i = 0; i <= count; ++i) {
    const cv::Point2d at = from + (to - from) * (double(i) / count);
    if (std::abs(at.x) > 1e5 || std::abs(at.y) > 1e5) continue;
    Block({cvRound(at.x) - width / 2, cvRound(at.y) - width / 2, width, width});
  }
}

bool FreeSpace::IsFree(cv::Rect part) const {
  if ((part & cv::Rect({0, 0}, size_)) != part) return false;
  return cv::countNonZero(used_(Blocks(part))) == 0;
}

bool FreeSpace::CrossesLabel(cv::Point2d from, cv::Point2d to, cv::Rect own) const {
  return std::any_of(labels_.begin(), labels_.end(), [&](const cv::Rect& label) {
    cv::Point a(from);
    cv::Point b(to);
    return label != own && cv::clipLine(label, a, b);
  });
}

std::optional<cv::Rect> FreeSpace::Find(cv::Size size, cv::Point2d near, double farthest) const {
  const cv::Size blocks((size.width + kBlock - 1) / kBlock + 1,
                        (size.height + kBlock - 1) / kBlock + 1);
  if (blocks.width > used_.cols || blocks.height > used_.rows) return std::nullopt;
  cv::Mat1i sums;
  cv::integral(used_, sums, CV_32S);
  double nearest = farthest;
  std::optional<cv::Point> best;
  // Returns the first and the last index along an axis at which a rectangle may be within reach.
  const auto range = [farthest](double middle, int length, int all) {
    const auto low = std::floor((middle - farthest) / kBlock - length / 2.0);
    const auto high = std::ceil((middle + farthest) / kBlock - length / 2.0);
    return std::pair(static_cast<int>(std::clamp(low, 0.0, double(all - length) + 1.0)),
                     static_cast<int>(std::clamp(high, -1.0, double(all - length))));
  };
  const auto [top, bottom_most] = range(near.y, blocks.height, used_.rows);
  const auto [left, right_most] = range(near.x, blocks.width, used_.cols);
  for (int row = top; row <= bottom_most; ++row) {
    for (int column = left; column <= right_most; ++column) {
      const double away = std::hypot((column + blocks.width / 2.0) * kBlock - near.x,
                                     (row + blocks.height / 2.0) * kBlock - near.y);
      if (away >= nearest) continue;
      const int bottom = row + blocks.height;
      const int right = column + blocks.width;
      if (sums(bottom, right) - sums(row, right) - sums(bottom, column) + sums(row, column) > 0) {
        continue;
      }
      nearest = away;
      best = cv::Point(column, row);
    }
  }
  if (!best) return std::nullopt;
  return cv::Rect(best->x * kBlock + kBlock / 2, best->y * kBlock + kBlock / 2, size.width,
                  size.height);
}

void FreeSpace::Add(cv::Rect label) {
  Block(label + cv::Size(2 * kBlock, 2 * kBlock) - cv::Point(kBlock, kBlock));
  labels_.push_back(label);
}

std::optional<cv::Rect> FreeSpace::Take(cv::Size size, cv::Point2d near, double farthest) {
  const auto place = Find(size, near, farthest);
  if (place) Add(*place);
  return place;
}

}  // namespace aquafarm_viz
