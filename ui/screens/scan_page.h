#pragma once

#include "ui/screens/visit_page.h"
#include "ui/work/scan_camera.h"

#include <filesystem>
#include <functional>

class QFrame;
class QHBoxLayout;
class QLabel;
class QPushButton;

namespace tarsus {

class DistanceGauge;
class GrowingView;
class LivePicture;
class ScanDialog;

/// A good scan in 20 seconds: live pictures, the growing foot, one order at a time.
class ScanPage : public VisitPage {
  Q_OBJECT

 public:
  explicit ScanPage(VisitWork& work);
  ~ScanPage() override;
  void reset() override;
  void enter() override;
  void leave() override;
  void primary() override;
  [[nodiscard]] QString status() const override;
  [[nodiscard]] QString saved() const override;
  [[nodiscard]] QString headerNote(bool* trouble) const override;
  /// A given camera instead of the first found, by its address.
  void useCamera(const std::string& uri);
  [[nodiscard]] const ScanMoment& moment() const { return now_; }

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  enum class AtEnd { Use, Drop, Again };

  [[nodiscard]] QWidget* makeLeft();
  [[nodiscard]] QWidget* makeRight();
  [[nodiscard]] QWidget* makeDistance();
  void openCamera();
  void show(const ScanMoment& moment);
  void showState();
  void showFigures();
  void showOrder();
  void showDialogs();
  void startOrStop();
  void begin();
  void end(AtEnd then);
  void ended(int frames, const Error& problem);
  void retake();
  void cancel();
  void chooseFile();
  void takeNoScan();
  void offerKept();
  [[nodiscard]] std::filesystem::path take() const;
  [[nodiscard]] bool lost() const;
  [[nodiscard]] QString keptSeconds() const;

  std::unique_ptr<ScanCamera> camera_;
  std::string uri_;
  ScanMoment now_;
  bool recording_ = false;
  bool waiting_ = false;  ///< for the camera's thread to begin or end
  bool was_lost_ = false;
  bool gone_told_ = false;
  AtEnd at_end_ = AtEnd::Use;
  std::filesystem::path take_;
  QWidget* left_ = nullptr;
  QWidget* right_ = nullptr;
  QWidget* distance_ = nullptr;
  LivePicture* color_ = nullptr;
  LivePicture* depth_ = nullptr;
  GrowingView* foot_ = nullptr;
  ScanDialog* dialog_ = nullptr;
  QFrame* state_ = nullptr;
  QLabel* state_icon_ = nullptr;
  QLabel* state_title_ = nullptr;
  QLabel* state_text_ = nullptr;
  DistanceGauge* gauge_ = nullptr;
  QLabel* left_s_ = nullptr;
  QLabel* paused_ = nullptr;
  QLabel* seen_ = nullptr;
  QLabel* distance_text_ = nullptr;
  QPushButton* retake_ = nullptr;
  QPushButton* file_ = nullptr;
  QPushButton* none_ = nullptr;
  QPushButton* go_ = nullptr;
};

}  // namespace tarsus
