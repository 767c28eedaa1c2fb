#include "reconstruction/scene/stl.h"

#include "reconstruction/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace tarsus {
namespace {

/// A tetrahedron, faces outward.
TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(Stl, HasTheLayoutThatSlicersRead) {
  const std::string bytes = stlBytes(tetrahedron());
  ASSERT_EQ(bytes.size(), 84U + 4U * 50U);
  EXPECT_NE(bytes.substr(0, 5), "solid");  // would be taken for the text form
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(count, 4U);
  std::array<float, 12> face{};
  std::memcpy(face.data(), bytes.data() + 84, sizeof face);
  const std::array<float, 12> expected{0, 0, -1, 0, 0, 0, 0, 10, 0, 10, 0, 0};
  EXPECT_EQ(face, expected);
}

TEST(Stl, ReadsBackWithSharedVertices) {
  const TriangleMesh mesh = tetrahedron();
  const auto read = parseStl(stlBytes(mesh), "a.stl");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->vertices.size(), 4U);
  ASSERT_EQ(read->faces.size(), 4U);
  for (std::size_t f = 0; f < 4; ++f) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(read->vertices[static_cast<std::size_t>(read->faces[f][k])],
                mesh.vertices[static_cast<std::size_t>(mesh.faces[f][k])]);
    }
  }
}

TEST(Stl, RefusesDamage) {
  const std::string whole = stlBytes(tetrahedron());
  const auto refused = [](const std::string& bytes) {
    const auto read = parseStl(bytes, "a.stl");
    return !read && read.error().code == ErrorCode::MeshInvalid &&
           read.error().detail.find("a.stl") != std::string::npos;
  };
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    EXPECT_TRUE(refused(whole.substr(0, length))) << length;
  }
  std::string many = whole;
  many.replace(80, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_TRUE(refused(many));
  std::string none = whole;
  none.replace(80, 4, std::string(4, '\0'));
  EXPECT_TRUE(refused(none));
  std::string not_finite = whole;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(not_finite.data() + 84 + 12, &nan, 4);
  EXPECT_TRUE(refused(not_finite));
  EXPECT_TRUE(refused("solid text\nendsolid\n"));
}

TEST(Stl, ReadsFilesAndSaysWhichIsMissing) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "body.stl";
  EXPECT_EQ(readStl(path).error().code, ErrorCode::FileMissing);
  ASSERT_TRUE(writeTextAtomically(path, stlBytes(tetrahedron())));
  const auto read = readStl(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->faces.size(), 4U);
}

}  // namespace
}  // namespace tarsus
