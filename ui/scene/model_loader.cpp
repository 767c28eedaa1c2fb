#include "ui/scene/model_loader.h"

#include "reconstruction/scene/ply.h"

#include <QFile>
#include <QMetaObject>

namespace tarsus {

ModelLoader::ModelLoader(QObject* parent) : QObject(parent) {}

void ModelLoader::load(const QString& path) {
  worker_ = std::jthread([this, path] {
    Expected<TexturedMesh> model = readPly(QFile::encodeName(path).toStdString());
    if (model) {
      auto shared = std::make_shared<const TexturedMesh>(std::move(*model));
      QMetaObject::invokeMethod(
          this, [this, path, shared] { emit loaded(path, shared); }, Qt::QueuedConnection);
    } else {
      QMetaObject::invokeMethod(
          this,
          [this, path, error = model.error()] { emit refused(path, error); },
          Qt::QueuedConnection);
    }
  });
}

}  // namespace tarsus
