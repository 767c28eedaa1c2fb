#pragma once

#include "ui/work/scan_build.h"
#include "ui/work/visit_facts.h"

#include <QObject>
#include <QTimer>

#include <filesystem>
#include <memory>

namespace tarsus {

class Session;

/// The visit that is being worked on: its facts, the form, its folder, the scan and the model. The
/// steps share it and keep nothing of their own that must last.
///
/// Scan and model lie in records/work/VISIT, for this user only: scan or scan.oni, model/, and take
/// while a scan is being recorded. They are found again after a crash, and go once the visit is
/// measured and its files are in the records.
class VisitWork : public QObject {
  Q_OBJECT

 public:
  explicit VisitWork(Session& session, QObject* parent = nullptr);

  /// Reads the visit; opened() or refused() follows. The form of another visit is saved first.
  void open(const QString& visit_id);
  void close();
  [[nodiscard]] bool isOpen() const { return open_; }
  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const VisitFacts& facts() const { return facts_; }
  [[nodiscard]] bool mayEdit() const;

  [[nodiscard]] const nlohmann::json& fields() const { return now_; }
  /// A value that the field may have; null takes it out. Saved within half a second.
  void setField(const std::string& name, const nlohmann::json& value);
  /// The visit is measured by ruler and probe.
  void setNoScan(bool no_scan);
  [[nodiscard]] bool noScan() const { return no_scan_; }
  /// What was typed goes to the records now.
  void save();
  /// After another step has written to the visit (a measurement, a signature).
  void took(const Visit& visit);

  [[nodiscard]] std::filesystem::path folder() const;  ///< made, for this user only
  [[nodiscard]] bool hasScan() const { return has_scan_; }
  /// A recording was ended: it becomes the visit's scan, and its model is built.
  void takeRecording(const std::filesystem::path& recording);
  /// A scan folder or an .oni file is copied in, and its model is built.
  void useFile(const std::filesystem::path& scan);
  [[nodiscard]] ScanBuild& build() { return build_; }
  [[nodiscard]] std::shared_ptr<const TexturedMesh> model() const { return build_.built().model; }
  /// The model stands and may be measured.
  [[nodiscard]] bool modelIsFit() const {
    return build_.state() == ScanBuild::State::Ready && build_.built().quality.fit();
  }

 signals:
  void opened();
  void refused(const tarsus::Error& error);
  void fieldChanged(const QString& name);
  /// Another station wrote meanwhile: both are kept; `disputed` fields were changed at both.
  void merged(const QStringList& disputed);
  void saveFailed(const tarsus::Error& error);
  void scanChanged();

 private:
  void adopt(VisitFacts facts);
  void finishSave(const Expected<FormSaved>& saved);
  [[nodiscard]] bool hasTypedMeasure() const;

  Session& session_;
  VisitFacts facts_;
  bool open_ = false;
  bool saving_ = false;
  bool no_scan_ = false;
  bool has_scan_ = false;
  QString wanted_;
  nlohmann::json before_;  ///< as the records have it
  nlohmann::json sent_;    ///< on its way there
  nlohmann::json now_;
  QTimer soon_;
  ScanBuild build_;
};

}  // namespace tarsus
