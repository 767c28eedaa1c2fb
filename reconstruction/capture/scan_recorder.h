#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace tarsus {

/// Nobody else records into this folder while it is held. Given up, it takes with it a folder in
/// which nothing was recorded.
class ScanClaim {
 public:
  /// Makes the folder. A scan cannot be taken a second time: none is written over.
  /// @errors BadOption (being recorded now, or a scan is there), FileUnwritable
  [[nodiscard]] static Expected<ScanClaim> take(const std::filesystem::path& folder);
  ScanClaim(ScanClaim&& other) noexcept;
  ScanClaim& operator=(ScanClaim&&) = delete;
  ScanClaim(const ScanClaim&) = delete;
  ScanClaim& operator=(const ScanClaim&) = delete;
  ~ScanClaim();

 private:
  ScanClaim(std::filesystem::path folder, int file) : folder_(std::move(folder)), file_(file) {}
  std::filesystem::path folder_;
  int file_ = -1;  ///< locked; -1: moved away
};

struct RecorderOptions {
  int most_waiting = 45;               ///< frames in memory (2 MB each) before one is dropped
  double least_free_mb = 500.0;        ///< recording ends before the disk is fuller than that
  std::optional<double> free_mb = {};  ///< instead of the disk's, for tests
  ScanFacts facts = {};                ///< of the scan, beyond its camera
};

struct RecorderCounts {
  int written = 0;
  int dropped = 0;  ///< the disk was too slow for them
  double megabytes = 0.0;
};

/// Writes frames as a camera gives them into a scan folder while the scan goes on, without loss
/// (PNG). The folder is a scan at each moment: its lists grow with each frame, so that whatever
/// interrupts the recording loses only the frames in memory, under a second. An .oni file cannot
/// give that (an interrupted one is unreadable); writeOniRecording makes one of the folder
/// afterwards.
class ScanRecorder {
 public:
  /// @param camera  as the sensor is, with distortion
  /// @errors FileUnwritable, DiskFull (less than `expected_s` of the scan would fit)
  [[nodiscard]] static Expected<std::unique_ptr<ScanRecorder>> create(
      const std::filesystem::path& folder,
      const RgbdCamera& camera,
      double expected_s,
      const RecorderOptions& options = {});
  /// Writes what waits.
  ~ScanRecorder();
  ScanRecorder(const ScanRecorder&) = delete;
  ScanRecorder& operator=(const ScanRecorder&) = delete;
  ScanRecorder(ScanRecorder&&) = delete;
  ScanRecorder& operator=(ScanRecorder&&) = delete;

  /// Never waits: the frame is written by threads of the recorder's own, and shared with whoever
  /// shows or tracks it meanwhile. Its index is of no account. False: dropped.
  bool add(std::shared_ptr<const RgbdFrame> frame);
  /// Writes what waits and closes the lists; the first failure, if there was one. What was written
  /// before it is kept.
  /// @errors FileUnwritable, DiskFull
  [[nodiscard]] Expected<void> finish();
  [[nodiscard]] RecorderCounts counts() const;
  /// Why nothing more is written; empty while all is well.
  [[nodiscard]] std::optional<Error> failure() const;

 private:
  struct State;
  explicit ScanRecorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
