#include "ui/screens/model_facts.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

TexturedMesh triangle() {
  TexturedMesh model;
  model.mesh.vertices = {{0, 0, 0}, {100, 0, 0}, {0, 50, 25}};
  model.mesh.faces = {{0, 1, 2}};
  return model;
}

QString valueOf(const ModelFacts& facts, const char* name) {
  for (const auto& [key, value] : facts.rows) {
    if (key == QLatin1String(name)) {
      return value;
    }
  }
  return {};
}

TEST(ModelFacts, SaysWhatIsThereAndNothingElse) {
  const ModelFacts facts = factsOf(triangle());
  EXPECT_EQ(valueOf(facts, "Triangles"), QStringLiteral("1"));
  EXPECT_EQ(valueOf(facts, "Points"), QStringLiteral("3"));
  EXPECT_EQ(valueOf(facts, "Size"), QStringLiteral(u"100\u00A0×\u00A050\u00A0×\u00A025\u00A0mm"));
  EXPECT_EQ(valueOf(facts, "Colour"), QStringLiteral("none"));
  EXPECT_TRUE(valueOf(facts, "Not seen in colour").isEmpty());
  EXPECT_TRUE(valueOf(facts, "Typical uncertainty").isEmpty());
}

TEST(ModelFacts, ReadsFitnessFromTheCommentsAndNeverAssumesIt) {
  TexturedMesh model = triangle();
  EXPECT_EQ(factsOf(model).fitness, Fitness::NotStated);
  model.comments = {"Tarsus 0.1.0", "fit_for_measurement yes"};
  EXPECT_EQ(factsOf(model).fitness, Fitness::Fit);
  model.comments = {"fit_for_measurement no"};
  EXPECT_EQ(factsOf(model).fitness, Fitness::Unfit);
}

TEST(ModelFacts, CountsSharesAndMedians) {
  TexturedMesh model = triangle();
  model.unseen = {0, 1, 1};
  model.sigma_mm = {0.1F, 0.3F, 0.2F};
  const ModelFacts facts = factsOf(model);
  EXPECT_EQ(valueOf(facts, "Not seen in colour"), QStringLiteral(u"67\u00A0%"));
  EXPECT_TRUE(valueOf(facts, "Typical uncertainty").startsWith(QStringLiteral("0")));
  EXPECT_TRUE(valueOf(facts, "Typical uncertainty").contains(QStringLiteral("20")));
}

}  // namespace
}  // namespace tarsus
