#include "ui/screens/model_facts.h"

#include <QCoreApplication>
#include <QLocale>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ModelFacts)
};

QString counted(std::size_t count) {
  // Groups of three with a narrow no-break space read the same in every language.
  QString digits = QString::number(static_cast<qulonglong>(count));
  for (int at = digits.size() - 3; at > 0; at -= 3) {
    digits.insert(at, QChar(0x202F));
  }
  return digits;
}

QString sizeOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    box.extend(p);
  }
  const QString times = QStringLiteral(u"\u00A0\u00D7\u00A0");
  const auto side = [&](int axis) {
    return counted(static_cast<std::size_t>(std::lround(box.sizes()[axis])));
  };
  return side(0) + times + side(1) + times + side(2) + QStringLiteral(u"\u00A0mm");
}

QString shareOf(const std::vector<std::uint8_t>& unseen) {
  const auto count =
      std::count_if(unseen.begin(), unseen.end(), [](std::uint8_t u) { return u != 0; });
  const double share = 100.0 * static_cast<double>(count) / static_cast<double>(unseen.size());
  return QLocale().toString(share, 'f', share < 10.0 ? 1 : 0) + QStringLiteral(u"\u00A0%");
}

QString medianOf(std::vector<float> sigma_mm) {
  const auto middle = sigma_mm.begin() + static_cast<std::ptrdiff_t>(sigma_mm.size() / 2);
  std::nth_element(sigma_mm.begin(), middle, sigma_mm.end());
  return QLocale().toString(static_cast<double>(*middle), 'f', 2) + QStringLiteral(u"\u00A0mm");
}

Fitness fitnessOf(const std::vector<std::string>& comments) {
  for (const std::string& comment : comments) {
    if (comment.find("fit_for_measurement no") != std::string::npos) {
      return Fitness::Unfit;
    }
    if (comment.find("fit_for_measurement yes") != std::string::npos) {
      return Fitness::Fit;
    }
  }
  return Fitness::NotStated;
}

QString fitnessText(Fitness fitness) {
  switch (fitness) {
    case Fitness::Fit:
      return Words::tr("✓  Fit for measurement");
    case Fitness::Unfit:
      return Words::tr("✕  Not fit for measurement");
    case Fitness::NotStated:
      break;
  }
  return Words::tr("?  The file does not say if it is fit");
}

}  // namespace

ModelFacts factsOf(const TexturedMesh& model) {
  ModelFacts facts;
  facts.fitness = fitnessOf(model.comments);
  facts.fitness_text = fitnessText(facts.fitness);
  facts.rows = {{Words::tr("Triangles"), counted(model.mesh.faces.size())},
                {Words::tr("Points"), counted(model.mesh.vertices.size())},
                {Words::tr("Size"), sizeOf(model.mesh)},
                {Words::tr("Colour"), model.colors.empty() ? Words::tr("none") : Words::tr("yes")}};
  if (!model.unseen.empty()) {
    facts.rows.emplace_back(Words::tr("Not seen in colour"), shareOf(model.unseen));
  }
  if (!model.sigma_mm.empty()) {
    facts.rows.emplace_back(Words::tr("Typical uncertainty"), medianOf(model.sigma_mm));
  }
  for (const std::string& comment : model.comments) {
    facts.comments << QString::fromStdString(comment);
  }
  return facts;
}

}  // namespace tarsus
