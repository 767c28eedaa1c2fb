#include "reconstruction/base/atomic_file.h"
#include "reconstruction/scene/ply.h"
#include "tests/reconstruction/scene/shapes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace tarsus {
namespace {

// Whatever the bytes, a reader gives a usable mesh or an error: it never crashes, hangs or asks
// for more memory than the file can justify.

void expectUsable(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  ASSERT_FALSE(mesh.faces.empty());
  for (const Eigen::Vector3i& face : mesh.faces) {
    ASSERT_GE(face.minCoeff(), 0);
    ASSERT_LT(face.maxCoeff(), count);
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    ASSERT_TRUE(vertex.allFinite());
  }
}

void expectUsable(const TexturedMesh& model) {
  expectUsable(model.mesh);
  const std::size_t count = model.mesh.vertices.size();
  for (const std::size_t size : {model.colors.size(),
                                 model.mesh.normals.size(),
                                 model.sigma_mm.size(),
                                 model.observations.size(),
                                 model.unseen.size()}) {
    ASSERT_TRUE(size == 0 || size == count);
  }
}

std::size_t below(Dice& dice, std::size_t limit) {
  return static_cast<std::size_t>(dice.roll() * static_cast<double>(limit));
}

/// One of: bytes changed, a piece cut out, a piece doubled, the end cut off, a digit changed.
std::string damaged(std::string bytes, Dice& dice) {
  const std::size_t at = below(dice, bytes.size());
  const std::size_t length = 1 + below(dice, 40);
  switch (dice.bits() % 6) {
    case 0:
      bytes[at] = static_cast<char>(dice.bits());
      break;
    case 1:
      for (int i = 0; i < 8; ++i) {
        bytes[below(dice, bytes.size())] = static_cast<char>(dice.bits());
      }
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(at, bytes.substr(below(dice, bytes.size()), length));
      break;
    case 4:
      bytes.resize(at);
      break;
    default:
      bytes[below(dice, 500) % bytes.size()] = static_cast<char>('0' + dice.bits() % 10);
      break;
  }
  return bytes;
}

template <typename Read>
void expectMeshOrError(const std::string& valid, const std::string& name, const Read& read) {
  const TemporaryFolder folder;
  const auto path = folder.path() / name;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    std::filesystem::remove(path);  // ext4 flushes a file that is cut to nothing and refilled
    std::ofstream(path, std::ios::binary) << damaged(valid, dice);
    const auto result = read(path);
    if (result) {
      expectUsable(*result);
    } else {
      ++refused;
      ASSERT_TRUE(result.error().code == ErrorCode::MeshInvalid ||
                  result.error().code == ErrorCode::FileUnreadable);
    }
  }
  EXPECT_GT(refused, 500);  // the damage is real: a sixth of the files at least lack their end
}

std::string binaryModel() {
  const TemporaryFolder folder;
  EXPECT_TRUE(writePly(folder.path() / "a.ply", makeModel(makeCube(10.0))));
  return readTextFile(folder.path() / "a.ply").value();
}

std::string textModel() {
  std::string text =
      "ply\nformat ascii 1.0\ncomment a\nelement vertex 8\nproperty float x\nproperty double y\n"
      "property float z\nproperty list uchar int extra\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  const TriangleMesh cube = makeCube(10.0);
  for (const auto& v : cube.vertices) {
    text += std::to_string(v.x()) + ' ' + std::to_string(v.y()) + ' ' + std::to_string(v.z()) +
            " 2 7 8 10 20 30\n";
  }
  for (const auto& f : cube.faces) {
    text += "3 " + std::to_string(f[0]) + ' ' + std::to_string(f[1]) + ' ' + std::to_string(f[2]) +
            '\n';
  }
  return text;
}

std::string objModel() {
  std::string text = "# cube\nmtllib none.mtl\no cube\n";
  const TriangleMesh cube = makeCube(10.0);
  for (const auto& v : cube.vertices) {
    text += "v " + std::to_string(v.x()) + ' ' + std::to_string(v.y()) + ' ' +
            std::to_string(v.z()) + "\nvt 0 0\n";
  }
  for (const auto& f : cube.faces) {
    text += "f " + std::to_string(f[0] + 1) + "/1/1 " + std::to_string(f[1] - 8) + "//1 " +
            std::to_string(f[2] + 1) + "/1\n";
  }
  return text;
}

TEST(PlyDamage, BinaryFilesGiveAMeshOrAnError) {
  expectMeshOrError(binaryModel(), "a.ply", readPly);
}

TEST(PlyDamage, BigEndianFilesGiveAMeshOrAnError) {
  // The same bytes read in the other order: sizes and indices without sense.
  std::string bytes = binaryModel();
  bytes.replace(bytes.find("little"), 6, "big");
  expectMeshOrError(bytes, "a.ply", readPly);
}

TEST(PlyDamage, TextFilesGiveAMeshOrAnError) { expectMeshOrError(textModel(), "a.ply", readPly); }

TEST(ObjDamage, FilesGiveAMeshOrAnError) { expectMeshOrError(objModel(), "a.obj", readObj); }

TEST(PlyDamage, AFileCutAnywhereInABinaryBodyIsUnreadable) {
  const TemporaryFolder folder;
  const std::string valid = binaryModel();
  for (std::size_t length = 0; length < valid.size(); ++length) {
    std::ofstream(folder.path() / "a.ply", std::ios::binary) << valid.substr(0, length);
    const auto read = readPly(folder.path() / "a.ply");
    ASSERT_FALSE(read) << length;
    ASSERT_TRUE(length < 4 || read.error().code == ErrorCode::FileUnreadable) << length;
  }
}

}  // namespace
}  // namespace tarsus
