#pragma once

#include "reconstruction/capture/frame_source.h"
#include "reconstruction/capture/scan_hash.h"

#include <memory>
#include <string>

namespace tarsus {

/// Passes frames on and adds each to the scan's hash on the way.
class HashingSource final : public FrameSource {
 public:
  explicit HashingSource(std::unique_ptr<FrameSource> source);

  [[nodiscard]] const RgbdCamera& camera() const override { return source_->camera(); }
  [[nodiscard]] std::optional<int> frameCount() const override { return source_->frameCount(); }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override;
  [[nodiscard]] const Warnings& warnings() const override { return source_->warnings(); }

  /// Of all frames passed on; call once, at the end.
  [[nodiscard]] std::string hex() { return hash_.hex(); }

 private:
  std::unique_ptr<FrameSource> source_;
  ScanHash hash_;
};

}  // namespace tarsus
