#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <QObject>
#include <QString>

#include <memory>
#include <thread>

namespace tarsus {

/// Reads model files away from the window's thread. The signals arrive in the thread that owns it.
class ModelLoader : public QObject {
  Q_OBJECT

 public:
  explicit ModelLoader(QObject* parent = nullptr);

  /// Begins to read; waits for a file that is still being read. One of the two signals follows.
  void load(const QString& path);

 signals:
  void loaded(const QString& path, std::shared_ptr<const tarsus::TexturedMesh> model);
  void refused(const QString& path, const tarsus::Error& error);

 private:
  std::jthread worker_;
};

}  // namespace tarsus

Q_DECLARE_METATYPE(std::shared_ptr<const tarsus::TexturedMesh>)
Q_DECLARE_METATYPE(tarsus::Error)
