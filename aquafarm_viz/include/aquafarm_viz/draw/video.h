// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Pictures in a row as a file: mp4 and webm by OpenCV's codecs, gif by giflib.

#include <memory>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// A picture or film that could not be written.
struct StorageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A film of pictures of one size. It is written beside its place and comes there when it is whole.
class Film {
 public:
  /// @param path its ending says what it becomes: .mp4, .webm or .gif
  /// @throws std::runtime_error for another ending or no codec
  /// @throws StorageError for a place that cannot be written
  static std::unique_ptr<Film> Open(const std::string& path, cv::Size size, double rate_hz);

  virtual ~Film() = default;
  /// @param picture 8-bit BGR of the film's size
  virtual void Add(const cv::Mat& picture) = 0;
  /// @throws StorageError when it could not be written
  virtual void Close() = 0;

  /// Says whether a path has the ending of a film.
  static bool Is(const std::string& path);
};

/// The 256 colours that pictures are best shown with, from a sample of their pixels, as BGR.
std::vector<cv::Vec3b> Palette(const std::vector<cv::Mat>& pictures);

}  // namespace aquafarm_viz
