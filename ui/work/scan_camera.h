#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/pipeline/scan_guide.h"

#include <QImage>
#include <QObject>
#include <QRectF>

#include <filesystem>
#include <memory>
#include <optional>

namespace tarsus {

/// What the scan screen shows at one moment.
struct ScanMoment {
  enum class Camera {
    Looking,    ///< for one
    None,       ///< none is plugged in
    Preparing,  ///< the simulated foot is being made
    Live,
    Gone,  ///< unplugged; goes on by itself when it comes back
    Failed
  };
  Camera camera = Camera::Looking;
  QString name;
  bool simulated = false;
  double prepared = 0.0;  ///< of the simulated foot, 0 to 1
  bool recording = false;
  QImage color;
  QImage depth;
  QImage foot;  ///< null: as before
  QRectF aim;   ///< where the scan was last at home, in parts of the foot's picture; may be empty
  ScanGuidance guidance;
  bool tracked = false;  ///< since the scan was begun
  int frames = 0;        ///< written
  Error problem;         ///< of Failed, or why recording ended by itself
  bool stopped = false;  ///< recording ended by itself (disk full)
};

/// Camera, recording and tracking in a thread of their own; what there is to show comes to the
/// window's about 15 times a second, ready as pictures.
class ScanCamera : public QObject {
  Q_OBJECT

 public:
  /// Distances that the depth picture spans [mm].
  static constexpr double kNear_mm = 280.0;
  static constexpr double kFar_mm = 560.0;

  /// @param own  folder for a simulated foot, made when it is asked for
  explicit ScanCamera(std::filesystem::path own, QObject* parent = nullptr);
  ~ScanCamera() override;

  /// Looks for a camera until there is one, and shows it.
  void start();
  /// Gives the camera free; a recording is ended.
  void stop();
  /// A foot that the program makes itself stands for a camera.
  void simulate();
  /// A given camera instead of the first found, by its address.
  void setUri(const std::string& uri);
  void begin(const std::filesystem::path& folder);
  /// ended() follows.
  void end();

 signals:
  void shown(const tarsus::ScanMoment& moment);
  void begun();
  /// @param frames   that lie in the folder now
  /// @param problem  Cancelled: none
  void ended(int frames, const tarsus::Error& problem);

 private:
  struct Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace tarsus
