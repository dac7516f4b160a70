// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Writes sequences of pictures to video files: mp4 and webm with OpenCV's codecs, gif with giflib.

#include <memory>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// Thrown when a picture or video cannot be written.
struct StorageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A video of pictures of one size. It is written to a temporary file in the same folder, which is
/// renamed when the video is complete.
class Video {
 public:
  /// @param path its extension selects the format: .mp4, .webm or .gif
  /// @throws std::runtime_error for another extension, or if no codec is available
  /// @throws StorageError if the file cannot be written
  static std::unique_ptr<Video> Open(const std::string& path, cv::Size size, double rate_hz);

  virtual ~Video() = default;
  /// @param picture 8-bit BGR, of the size given to Open
  virtual void Add(const cv::Mat& picture) = 0;
  /// Completes the file. @throws StorageError if it could not be written
  virtual void Close() = 0;

  /// Returns true if a path has the extension of a video.
  static bool Is(const std::string& path);
};

/// Returns a palette of 256 BGR colours for the pictures, computed from a sample of their pixels.
std::vector<cv::Vec3b> Palette(const std::vector<cv::Mat>& pictures);

}  // namespace aquafarm_viz
