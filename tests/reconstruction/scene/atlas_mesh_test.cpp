#include "reconstruction/scene/atlas_mesh.h"

#include "reconstruction/scene/ply.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

namespace tarsus {
namespace {

/// Two triangles with a seam between them: vertices 1 and 2 have two places each.
AtlasMesh seamed() {
  AtlasMesh model;
  model.mesh.vertices = {
      {0.0F, 0.0F, 0.1F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {1.0F, 1e-7F, 3.0F}};
  model.mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  model.mesh.faces = {{0, 1, 2}, {2, 1, 3}};
  model.uv = {{0.0F, 0.0F}, {0.25F, 0.0F}, {0.0F, 0.3F}, {0.5F, 0.5F}, {0.75F, 0.5F}, {1.0F, 1.0F}};
  model.uv_faces = {{0, 1, 2}, {3, 4, 5}};
  return model;
}

std::string textOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(TexturedObj, ReadsBackAsItWas) {
  const TemporaryFolder folder;
  const AtlasMesh model = seamed();
  ASSERT_TRUE(writeTexturedObj(folder.path() / "a.obj", model, "a.png"));
  const auto mesh = readObj(folder.path() / "a.obj");
  ASSERT_TRUE(mesh) << describe(mesh.error());
  EXPECT_EQ(mesh->vertices, model.mesh.vertices);  // to the last bit
  EXPECT_EQ(mesh->faces, model.mesh.faces);
  // Places, by hand: our reader takes no texture.
  std::istringstream lines(textOf(folder.path() / "a.obj"));
  std::vector<Eigen::Vector2f> places;
  std::vector<std::string> faces;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "vt") {
      Eigen::Vector2f place;
      words >> place.x() >> place.y();
      places.push_back(place);
    } else if (keyword == "f") {
      faces.push_back(line);
    }
  }
  EXPECT_EQ(places, model.uv);
  EXPECT_EQ(faces, (std::vector<std::string>{"f 1/1/1 2/2/2 3/3/3", "f 3/4/3 2/5/2 4/6/4"}));
  EXPECT_NE(textOf(folder.path() / "a.obj").find("mtllib a.mtl\n"), std::string::npos);
  EXPECT_NE(textOf(folder.path() / "a.mtl").find("map_Kd a.png\n"), std::string::npos);
}

TEST(TexturedPly, CarriesThePlacesOfEachFace) {
  const TemporaryFolder folder;
  const AtlasMesh model = seamed();
  ASSERT_TRUE(writeTexturedPly(folder.path() / "a.ply", model, "a.png"));
  const auto mesh = readPly(folder.path() / "a.ply");  // skips texcoord
  ASSERT_TRUE(mesh) << describe(mesh.error());
  EXPECT_EQ(mesh->mesh.vertices, model.mesh.vertices);
  EXPECT_EQ(mesh->mesh.faces, model.mesh.faces);
  const std::string bytes = textOf(folder.path() / "a.ply");
  EXPECT_NE(bytes.find("comment TextureFile a.png\n"), std::string::npos);
  EXPECT_NE(bytes.find("property list uchar float texcoord\n"), std::string::npos);
  ASSERT_GE(bytes.size(), 25U);
  const std::size_t last = bytes.size() - 25;  // 6, then three places
  EXPECT_EQ(bytes[last], '\6');
  std::array<float, 6> places{};
  std::memcpy(places.data(), bytes.data() + last + 1, sizeof places);
  EXPECT_EQ(places, (std::array<float, 6>{0.5F, 0.5F, 0.75F, 0.5F, 1.0F, 1.0F}));
}

TEST(TexturedObj, AFolderThatCannotBeWrittenIsRefused) {
  for (const auto& written : {writeTexturedObj("/proc/none/a.obj", seamed(), "a.png"),
                              writeTexturedPly("/proc/none/a.ply", seamed(), "a.png")}) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
    EXPECT_NE(describe(written.error()).find("/proc/none"), std::string::npos);
  }
}

}  // namespace
}  // namespace tarsus
