#pragma once

#include "reconstruction/scene/mesh.h"
#include "ui/work/background_job.h"

#include <QElapsedTimer>
#include <QObject>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace tarsus {

/// What is said of a scan once its model stands.
struct ScanQuality {
  int frames_total = 0;
  int frames_used = 0;
  int frames_contradicting = 0;
  std::optional<double> misfit_mm;
  double unseen_share = 0.0;  ///< of the model's surface, by no sharp picture
  Warnings reasons;           ///< why it must not be measured; empty: it may
  Warnings warnings;

  [[nodiscard]] bool fit() const { return reasons.empty(); }
};

/// A model as it was built from a scan.
struct BuiltModel {
  std::shared_ptr<const TexturedMesh> model;
  ScanQuality quality;
};

/// Copies a scan folder or a recording to where the visit keeps its scan, after a look whether it
/// is one; what was there before goes only once the new one is whole.
/// @param work  folder of the visit
/// @errors those of openScan, FileUnwritable, DiskFull, Cancelled
[[nodiscard]] Expected<void> bringScan(const std::filesystem::path& from,
                                       const std::filesystem::path& work,
                                       const Job& job);
/// Takes a file or folder out of the way at once and removes it beside the window: hundreds of
/// pictures take their time.
void removeSoon(const std::filesystem::path& path);
/// The visit's scan; empty: there is none.
[[nodiscard]] std::filesystem::path scanIn(const std::filesystem::path& work);

/// Scan to model beside the window, in five stages that are said in words.
class ScanBuild : public QObject {
  Q_OBJECT

 public:
  enum class State { None, Running, Ready, Failed, Cancelled };
  static constexpr int kStages = 5;
  struct Stage {
    bool done = false;
    bool running = false;
    double seconds = 0.0;
  };

  explicit ScanBuild(QObject* parent = nullptr);

  /// Builds <work>/model from the scan there; one that was built before is read.
  /// @param bring  a scan to be brought in first, or empty
  void start(const std::filesystem::path& work, const std::filesystem::path& bring = {});
  /// The scan is kept.
  void cancel();
  /// Forgets all: another visit.
  void clear();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] double fraction() const { return fraction_; }
  [[nodiscard]] std::array<Stage, kStages> stages() const;
  /// Empty while nobody can know.
  [[nodiscard]] std::optional<double> secondsLeft() const;
  [[nodiscard]] const BuiltModel& built() const { return built_; }
  [[nodiscard]] const Error& problem() const { return problem_; }

 signals:
  void changed();
  /// A scan that was brought in lies in the visit's folder now.
  void scanBrought();

 private:
  void begin();
  void progress(const QString& stage, double fraction);
  void enter(State state);

  BackgroundJob job_;
  State state_ = State::None;
  std::filesystem::path work_;
  std::filesystem::path bring_;
  double fraction_ = 0.0;
  int stage_ = 0;
  std::array<double, kStages> started_s_{};
  QElapsedTimer clock_;
  double ended_s_ = 0.0;
  BuiltModel built_;
  Error problem_;
};

}  // namespace tarsus
