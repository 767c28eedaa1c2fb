#pragma once

#include "reconstruction/scene/mesh.h"

#include <QString>
#include <QStringList>

#include <utility>
#include <vector>

namespace tarsus {

/// What a model file says about its own use.
enum class Fitness { Fit, Unfit, NotStated };

/// A model in words, for the side panel; needs no display.
struct ModelFacts {
  Fitness fitness = Fitness::NotStated;
  QString fitness_text;
  std::vector<std::pair<QString, QString>> rows;  ///< "Triangles" -> "193 000"
  QStringList comments;                           ///< as the file has them
};

[[nodiscard]] ModelFacts factsOf(const TexturedMesh& model);

}  // namespace tarsus
