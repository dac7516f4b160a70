// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/video.h"

#include <fcntl.h>
#include <gif_lib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <opencv2/videoio.hpp>
#include <stdexcept>

namespace aquafarm_viz {
namespace {

namespace fs = std::filesystem;

std::string Ending(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending;
}

/// Returns the path of the temporary file of a video. The temporary file has the extension of the
/// video, because OpenCV selects the format by the extension.
std::string TempPath(const std::string& path) {
  return (fs::path(path).parent_path() / (fs::path(path).stem().string() + ".part" + Ending(path)))
      .string();
}

void MoveToItsPlace(const std::string& path) {
  std::error_code error;
  fs::rename(TempPath(path), path, error);
  if (error) throw StorageError(path + ": could not be written: " + error.message());
}

void RemoveUnfinished(const std::string& path) {
  std::error_code ignored;
  fs::remove(TempPath(path), ignored);
}

/// Writes videos with the codecs that OpenCV finds on this machine.
class EncodedVideo final : public Video {
 public:
  EncodedVideo(const std::string& path, cv::Size size, double rate_hz, bool is_mp4) : path_(path) {
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    setenv("OPENCV_LOG_LEVEL", "OFF", 0);
    // For mp4, tries only H.264, because browsers play none of OpenCV's other mp4 codecs.
    const std::vector<std::string> codecs =
        is_mp4 ? std::vector<std::string>{"avc1"} : std::vector<std::string>{"VP90", "VP80"};
    std::string tried;
    for (const std::string& codec : codecs) {
      const int code = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
      if (writer_.open(TempPath(path), cv::CAP_FFMPEG, code, rate_hz, size)) return;
      tried += (tried.empty() ? "" : ", ") + codec;
    }
    RemoveUnfinished(path);
    throw std::runtime_error(path + ": no codec for " + Ending(path) + " (tried " + tried +
                             "), or the folder is not writable; use .gif, or install libavcodec");
  }

  ~EncodedVideo() override {
    writer_.release();
    RemoveUnfinished(path_);
  }

  void Add(const cv::Mat& picture) override {
    writer_.write(picture);
    ++pictures_;
  }

  // OpenCV does not report a full disk. Therefore Close counts the pictures of the written file.
  void Close() override {
    writer_.release();
    if (Pictures() < pictures_) {
      throw StorageError(path_ + ": could not be written completely");
    }
    MoveToItsPlace(path_);
  }

 private:
  int Pictures() const {
    cv::VideoCapture video(TempPath(path_), cv::CAP_FFMPEG);
    int pictures = 0;
    while (video.grab()) ++pictures;
    return pictures;
  }

  const std::string path_;
  cv::VideoWriter writer_;
  int pictures_{};
};

/// Finds the nearest colour of a palette, approximately, with a lookup table of 32 levels per
/// channel.
class Quantizer {
 public:
  explicit Quantizer(const std::vector<cv::Vec3b>& palette) : nearest_(kSide * kSide * kSide) {
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const cv::Vec3i color(Middle(i / (kSide * kSide)), Middle(i / kSide % kSide),
                            Middle(i % kSide));
      int nearest = std::numeric_limits<int>::max();
      for (std::size_t k = 0; k < palette.size(); ++k) {
        const cv::Vec3i off = color - cv::Vec3i(palette[k]);
        if (off.dot(off) >= nearest) continue;
        nearest = static_cast<int>(off.dot(off));
        nearest_[static_cast<std::size_t>(i)] = static_cast<GifByteType>(k);
      }
    }
  }

  GifByteType operator()(const cv::Vec3b& color) const {
    return nearest_[static_cast<std::size_t>((color[0] / kStep * kSide + color[1] / kStep) * kSide +
                                             color[2] / kStep)];
  }

 private:
  static constexpr int kSide = 32;
  static constexpr int kStep = 256 / kSide;
  static int Middle(int level) { return level * kStep + kStep / 2; }
  std::vector<GifByteType> nearest_;
};

/// Writes gifs. Buffers the first kFirst pictures, from which it computes the palette.
class GifVideo final : public Video {
 public:
  GifVideo(const std::string& path, cv::Size size, double rate_hz)
      : path_(path), size_(size), pause_(std::max(2, cvRound(100.0 / rate_hz))) {
    int error = 0;
    // giflib's own function would create a file that other users cannot read.
    const int handle = open(TempPath(path).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (handle >= 0) file_ = EGifOpenFileHandle(handle, &error);
    if (file_ == nullptr) throw StorageError(path + ": could not be written");
    EGifSetGifVersion(file_, true);
  }
  ~GifVideo() override {
    if (file_ != nullptr) EGifCloseFile(file_, nullptr);
    RemoveUnfinished(path_);
  }

  void Add(const cv::Mat& picture) override {
    if (quantizer_ != nullptr) return Write(picture);
    first_.push_back(picture.clone());
    if (first_.size() == kFirst) Begin();
  }

  void Close() override {
    if (quantizer_ == nullptr) Begin();
    const int closed = EGifCloseFile(file_, nullptr);
    file_ = nullptr;
    Check(closed);
    MoveToItsPlace(path_);
  }

 private:
  static constexpr std::size_t kFirst = 40;

  void Check(int done) const {
    if (done != GIF_OK) throw StorageError(path_ + ": could not be written");
  }

  void Begin() {
    const std::vector<cv::Vec3b> palette = Palette(first_);
    ColorMapObject* const colors = GifMakeMapObject(256, nullptr);
    for (std::size_t i = 0; i < palette.size(); ++i) {
      colors->Colors[i] = {palette[i][2], palette[i][1], palette[i][0]};
    }
    Check(EGifPutScreenDesc(file_, size_.width, size_.height, 8, 0, colors));
    GifFreeMapObject(colors);
    Check(EGifPutExtensionLeader(file_, APPLICATION_EXT_FUNC_CODE));
    Check(EGifPutExtensionBlock(file_, 11, "NETSCAPE2.0"));
    const std::array<GifByteType, 3> for_ever{1, 0, 0};
    Check(EGifPutExtensionBlock(file_, 3, for_ever.data()));
    Check(EGifPutExtensionTrailer(file_));
    quantizer_ = std::make_unique<Quantizer>(palette);
    for (const cv::Mat& picture : first_) Write(picture);
    first_.clear();
  }

  // Writes the rows from the first to the last changed one.
  void Write(const cv::Mat& picture) {
    cv::Mat indices(picture.size(), CV_8U);
    std::transform(picture.begin<cv::Vec3b>(), picture.end<cv::Vec3b>(), indices.begin<uchar>(),
                   *quantizer_);
    int top = 0;
    int bottom = indices.rows;
    if (!last_.empty()) {
      const auto same = [&](int row) {
        return std::equal(indices.ptr(row), indices.ptr(row) + indices.cols, last_.ptr(row));
      };
      while (top < bottom - 1 && same(top)) ++top;
      while (bottom - 1 > top && same(bottom - 1)) --bottom;
    }
    GraphicsControlBlock control{};
    control.DisposalMode = DISPOSE_DO_NOT;
    control.DelayTime = pause_;
    control.TransparentColor = NO_TRANSPARENT_COLOR;
    std::array<GifByteType, 4> bytes{};
    EGifGCBToExtension(&control, bytes.data());
    Check(EGifPutExtension(file_, GRAPHICS_EXT_FUNC_CODE, 4, bytes.data()));
    Check(EGifPutImageDesc(file_, 0, top, indices.cols, bottom - top, false, nullptr));
    for (int row = top; row < bottom; ++row) {
      Check(EGifPutLine(file_, indices.ptr(row), indices.cols));
    }
    last_ = indices;
  }

  const std::string path_;
  const cv::Size size_;
  const int pause_;  // time per picture [1/100 s], at least 2: viewers treat less as invalid
  GifFileType* file_{};
  std::vector<cv::Mat> first_;
  std::unique_ptr<Quantizer> quantizer_;
  cv::Mat last_;
};

}  // namespace

std::vector<cv::Vec3b> Palette(const std::vector<cv::Mat>& pictures) {
  constexpr int kSamples = 12000;
  constexpr int kColors = 256;
  std::size_t pixels = 0;
  for (const cv::Mat& picture : pictures) pixels += picture.total();
  const std::size_t step = std::max<std::size_t>(1, pixels / kSamples);
  std::vector<cv::Vec3f> samples;
  std::size_t at = 0;
  for (const cv::Mat& picture : pictures) {
    for (; at < picture.total(); at += step) {
      const auto cols = static_cast<std::size_t>(picture.cols);
      const auto row = static_cast<int>(at / cols);
      const auto col = static_cast<int>(at % cols);
      samples.emplace_back(picture.at<cv::Vec3b>(row, col));
    }
    at -= picture.total();
  }
  if (samples.size() < kColors) samples.resize(kColors);
  cv::Mat labels;
  cv::Mat centers;
  cv::theRNG().state = 1;  // for reproducible colours
  cv::kmeans(cv::Mat(samples).reshape(1), kColors, labels, {cv::TermCriteria::COUNT, 6, 0.0}, 1,
             cv::KMEANS_PP_CENTERS, centers);
  std::vector<cv::Vec3b> palette;
  for (int i = 0; i < kColors; ++i) palette.emplace_back(cv::Vec3b(centers.at<cv::Vec3f>(i, 0)));
  return palette;
}

bool Video::Is(const std::string& path) {
  const std::string ending = Ending(path);
  return ending == ".mp4" || ending == ".webm" || ending == ".gif";
}

std::unique_ptr<Video> Video::Open(const std::string& path, cv::Size size, double rate_hz) {
  if (!Is(path)) {
    throw std::runtime_error(path + ": got the extension '" + Ending(path) +
                             "', expected .mp4, .webm or .gif");
  }
  if (Ending(path) == ".gif") return std::make_unique<GifVideo>(path, size, rate_hz);
  return std::make_unique<EncodedVideo>(path, size, rate_hz, Ending(path) == ".mp4");
}

}  // namespace aquafarm_viz
