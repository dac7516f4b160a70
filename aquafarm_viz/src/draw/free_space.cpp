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

void FreeSpace::Block(cv::Rect part) {
  part &= cv::Rect({0, 0}, size_);
  if (part.empty()) return;
  const cv::Point low(part.x / kBlock, part.y / kBlock);
  const cv::Point high((part.x + part.width - 1) / kBlock + 1,
                       (part.y + part.height - 1) / kBlock + 1);
  used_(cv::Rect(low, high) & cv::Rect({0, 0}, used_.size())) = 1;
}

std::optional<cv::Rect> FreeSpace::Take(cv::Size size, cv::Point2d near, double farthest) {
  const cv::Size blocks((size.width + kBlock - 1) / kBlock + 1,
                        (size.height + kBlock - 1) / kBlock + 1);
  if (blocks.width > used_.cols || blocks.height > used_.rows) return std::nullopt;
  cv::Mat1i sums;
  cv::integral(used_, sums, CV_32S);
  double least = farthest;
  std::optional<cv::Point> best;
  // The first and the last position along an axis whose middle is within reach.
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
      if (away >= least) continue;
      const int bottom = row + blocks.height;
      const int right = column + blocks.width;
      if (sums(bottom, right) - sums(row, right) - sums(bottom, column) + sums(row, column) > 0) {
        continue;
      }
      least = away;
      best = cv::Point(column, row);
    }
  }
  if (!best) return std::nullopt;
  const cv::Rect place(best->x * kBlock + kBlock / 2, best->y * kBlock + kBlock / 2, size.width,
                       size.height);
  Block(place + cv::Size(2 * kBlock, 2 * kBlock) - cv::Point(kBlock, kBlock));
  return place;
}

}  // namespace aquafarm_viz
