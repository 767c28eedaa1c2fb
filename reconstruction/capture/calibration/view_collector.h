#pragma once

#include "reconstruction/capture/calibration/chessboard.h"

#include <chrono>
#include <optional>
#include <vector>

namespace tarsus {

/// What became of a look at the board.
enum class BoardLook {
  NotFound,  ///< not all of it is in the picture, or it is blurred
  Moving,    ///< not held still yet
  Seen,      ///< still, but as in a view that was taken before
  Taken,     ///< still and new: a view for the calibration
};

/// Chooses views for a calibration while somebody holds a board before the camera in many ways.
class ViewCollector {
 public:
  ViewCollector(const Chessboard& board, int image_width) : board_(board), width_px_(image_width) {}

  /// One picture after the other, in the order of time.
  [[nodiscard]] BoardLook add(std::chrono::microseconds time, const ColorImage& color);
  /// Whether the board still is where it was when the last view was taken.
  [[nodiscard]] bool stillAsTaken(const ColorImage& color) const;
  /// The last view does not count.
  void forgetLast();
  [[nodiscard]] int taken() const { return static_cast<int>(taken_.size()); }

 private:
  struct Look {
    std::chrono::microseconds time{};
    Corners corners;
  };
  Chessboard board_;
  int width_px_;
  std::optional<Look> before_;
  std::vector<Corners> taken_;
};

}  // namespace tarsus
