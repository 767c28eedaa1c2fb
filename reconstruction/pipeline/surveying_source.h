#pragma once

#include "reconstruction/capture/frame_source.h"
#include "reconstruction/texture/blur_measure.h"

#include <vector>

namespace tarsus {

/// Passes frames on and notes how sharp and bright each picture is on the way (0.6 ms for 640 x
/// 480), so that keyframes can be chosen without decoding the scan once more.
class SurveyingSource final : public FrameSource {
 public:
  /// @param source  must outlive this
  explicit SurveyingSource(FrameSource& source) : source_(source) {}

  [[nodiscard]] const RgbdCamera& camera() const override { return source_.camera(); }
  [[nodiscard]] std::optional<int> frameCount() const override { return source_.frameCount(); }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override;
  [[nodiscard]] const Warnings& warnings() const override { return source_.warnings(); }

  /// Of the frames passed on that have a picture.
  [[nodiscard]] std::vector<PictureQuality> takePictures() { return std::move(pictures_); }

 private:
  FrameSource& source_;
  std::vector<PictureQuality> pictures_;
};

}  // namespace tarsus
