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

/// A video whose pictures all have the same size. It is written to a temporary file in the folder
/// of the video, and Close renames this file. The destructor removes a temporary file that was not
/// renamed.
class Video {
 public:
  /// @param path its extension selects the format: .mp4, .webm or .gif
  /// @param rate_hz pictures per second, above 0; a gif has at most 50
  /// @throws std::runtime_error for any other extension, or if an mp4 or webm file cannot be
  ///         opened, because no codec is available or the folder is not writable
  /// @throws StorageError if a gif file cannot be created
  static std::unique_ptr<Video> Open(const std::string& path, cv::Size size, double rate_hz);

  virtual ~Video() = default;
  /// Appends a picture.
  /// @param picture 8-bit BGR, of the size given to Open
  /// @throws StorageError if a gif file cannot be written
  virtual void Add(const cv::Mat& picture) = 0;
  /// Completes the video. @throws StorageError if it could not be written
  virtual void Close() = 0;

  /// Returns true if a path has the extension .mp4, .webm or .gif, in upper or lower case.
  static bool Is(const std::string& path);
};

/// Returns a palette of 256 BGR colours for the pictures, computed from a sample of their pixels.
std::vector<cv::Vec3b> Palette(const std::vector<cv::Mat>& pictures);

}  // namespace aquafarm_viz
