#include "reconstruction/scene/ply.h"

#include "reconstruction/base/atomic_file.h"
#include "tests/reconstruction/scene/shapes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <numeric>
#include <stdexcept>

namespace tarsus {
namespace {

class Ply : public ::testing::Test {
 protected:
  Expected<TexturedMesh> readBytes(const std::string& bytes) {
    const auto path = folder_.path() / "in.ply";
    std::ofstream(path, std::ios::binary) << bytes;
    return readPly(path);
  }
  ErrorCode codeOf(const std::string& bytes) {
    const auto result = readBytes(bytes);
    EXPECT_FALSE(result) << bytes.substr(0, 300);
    return result ? ErrorCode::Cancelled : result.error().code;
  }
  TemporaryFolder folder_;
};

/// The two faces of a square, as text.
const std::string kSquareHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kSquare = kSquareHeader + "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";

template <typename T>
void put(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) {
    std::reverse(raw, raw + sizeof(T));
  }
  bytes.append(raw, sizeof(T));
}

bool equal(const Rgb8& a, const Rgb8& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

TEST_F(Ply, WhatIsWrittenIsReadToTheLastBit) {
  const TexturedMesh model = makeModel(makeSphere(40.0, 30));
  ASSERT_TRUE(writePly(folder_.path() / "model.ply", model));
  const auto read = readPly(folder_.path() / "model.ply");
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(read->mesh.vertices, model.mesh.vertices);
  EXPECT_EQ(read->mesh.normals, model.mesh.normals);
  EXPECT_EQ(read->mesh.faces, model.mesh.faces);
  EXPECT_TRUE(std::equal(
      read->colors.begin(), read->colors.end(), model.colors.begin(), model.colors.end(), equal));
  EXPECT_EQ(read->sigma_mm, model.sigma_mm);
  EXPECT_EQ(read->observations, model.observations);
  EXPECT_EQ(read->unseen, model.unseen);
  EXPECT_EQ(read->comments, model.comments);
  EXPECT_EQ(read->sha256, model.sha256);
}

TEST_F(Ply, TheHeaderIsWhatTheFormatFixes) {
  const TexturedMesh model = makeModel(makeCube(10.0));
  ASSERT_TRUE(writePly(folder_.path() / "model.ply", model));
  const std::string bytes = readTextFile(folder_.path() / "model.ply").value();
  const std::string expected =
      "ply\nformat binary_little_endian 1.0\ncomment tarsus 0.1.0\ncomment scan 0123abcd\n"
      "comment \nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nproperty float sigma_mm\n"
      "property ushort observations\nproperty uchar unseen\nelement face 12\n"
      "property list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(bytes.substr(0, expected.size()), expected);
  EXPECT_EQ(bytes.size(), expected.size() + 8 * 34 + 12 * 13);
}

TEST_F(Ply, WhatAModelLacksIsNotWrittenButNormalsAre) {
  TexturedMesh model;
  model.mesh = makeSphere(40.0, 30);
  ASSERT_TRUE(writePly(folder_.path() / "model.ply", model));
  const auto read = readPly(folder_.path() / "model.ply");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->colors.empty());
  EXPECT_TRUE(read->sigma_mm.empty());
  EXPECT_TRUE(read->observations.empty());
  EXPECT_TRUE(read->unseen.empty());
  EXPECT_EQ(read->mesh.normals, vertexNormals(model.mesh));
}

TEST_F(Ply, FurtherFieldsStandBehindTheVerticesOwn) {
  const TexturedMesh model = makeModel(makeCube(10.0));
  std::vector<float> depth_mm(model.mesh.vertices.size());
  std::iota(depth_mm.begin(), depth_mm.end(), -1.5F);
  const std::vector<VertexField> fields{{"depth_mm", depth_mm}, {"quality", depth_mm}};
  const auto path = folder_.path() / "model.ply";
  ASSERT_TRUE(writePly(path, model, fields));
  const std::string bytes = readTextFile(path).value();
  EXPECT_NE(bytes.find("property uchar unseen\nproperty float depth_mm\nproperty float quality\n"
                       "element face"),
            std::string::npos);
  // Our own reader passes them over and keeps everything else.
  const auto read = readPly(path);
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(read->mesh.vertices, model.mesh.vertices);
  EXPECT_EQ(read->unseen, model.unseen);
  // The last value of the first vertex: before the 34 bytes and two fields of the second.
  float last = 0.0F;
  const std::size_t begin = bytes.find("end_header\n") + 11;
  std::memcpy(&last, bytes.data() + begin + 34 + 4, sizeof last);
  EXPECT_EQ(last, -1.5F);
  std::memcpy(&last, bytes.data() + begin + 42 + 34, sizeof last);
  EXPECT_EQ(last, -0.5F);
  const std::vector<VertexField> unfit{{"depth_mm", std::span(depth_mm).first(2)}};
  EXPECT_THROW(static_cast<void>(writePly(path, model, unfit)), std::logic_error);
}

TEST_F(Ply, ACommentCannotEndTheHeader) {
  TexturedMesh model = makeModel(makeCube(10.0));
  model.comments = {"first\nend_header", "second\r"};
  ASSERT_TRUE(writePly(folder_.path() / "model.ply", model));
  const auto read = readPly(folder_.path() / "model.ply");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->comments, (std::vector<std::string>{"first end_header", "second "}));
  EXPECT_EQ(read->sha256, model.sha256);
}

TEST_F(Ply, TheSameModelGivesTheSameBytes) {
  const TexturedMesh model = makeModel(makePotato(20));
  ASSERT_TRUE(writePly(folder_.path() / "a.ply", model));
  ASSERT_TRUE(writePly(folder_.path() / "b.ply", model));
  EXPECT_EQ(readTextFile(folder_.path() / "a.ply").value(),
            readTextFile(folder_.path() / "b.ply").value());
}

TEST_F(Ply, ValuesOfTheWrongNumberAreABug) {
  TexturedMesh model = makeModel(makeCube(10.0));
  model.sigma_mm.pop_back();
  EXPECT_THROW(static_cast<void>(writePly(folder_.path() / "a.ply", model)), std::logic_error);
}

TEST_F(Ply, AnUnwritablePlaceIsAnErrorAndLeavesNothing) {
  std::filesystem::create_directories(folder_.path() / "a.ply" / "x");
  const auto written = writePly(folder_.path() / "a.ply", makeModel(makeCube(10.0)));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
}

TEST_F(Ply, ReadsText) {
  const auto square = readBytes(kSquare);
  ASSERT_TRUE(square) << describe(square.error());
  EXPECT_EQ(square->mesh.vertices[3], Eigen::Vector3f(0.0F, 1.0F, 0.5F));
  EXPECT_EQ(square->mesh.faces, (std::vector<Eigen::Vector3i>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(square->mesh.normals.empty());
  EXPECT_EQ(square->sha256.size(), 64U);
}

TEST_F(Ply, ReadsTextWithForeignLineEndsAndNumbers) {
  std::string text = kSquareHeader + "+0 0.0 0e5\n1e0 0 0\n  1.0 1 0\n\n0 1 5E-1\n3 0 1 2\n3 0 2 3";
  std::string with_returns;
  for (const char c : text) {
    with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  }
  const auto square = readBytes(with_returns);
  ASSERT_TRUE(square) << describe(square.error());
  EXPECT_EQ(square->sha256, readBytes(kSquare)->sha256);
}

TEST_F(Ply, ReadsBothByteOrdersWithForeignElementsAndTypes) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\ncomment by a test\nobj_info nothing\nelement camera 1\n"
                        "property list ushort double pose\nproperty int16 id\nelement vertex 4\n"
                        "property double x\nproperty list int8 float weights\nproperty float64 y\n"
                        "property float32 z\nproperty float red\nproperty float green\n"
                        "property float blue\nproperty float quality\nelement face 1\n"
                        "property uchar flags\nproperty list uint ushort vertex_index\n"
                        "property list uchar float texcoord\nelement edge 1\nproperty int v\n"
                        "end_header\n";
    put<std::uint16_t>(bytes, 2, big);
    put<double>(bytes, 1.5, big);
    put<double>(bytes, 2.5, big);
    put<std::int16_t>(bytes, -7, big);
    for (int i = 0; i < 4; ++i) {
      put<double>(bytes, i == 1 || i == 2 ? 1.0 : 0.0, big);
      put<std::int8_t>(bytes, 1, big);
      put<float>(bytes, 0.25F, big);
      put<double>(bytes, i >= 2 ? 1.0 : 0.0, big);
      put<float>(bytes, i == 3 ? 0.5F : 0.0F, big);
      put<float>(bytes, 1.0F, big);
      put<float>(bytes, 0.5F, big);
      put<float>(bytes, 0.0F, big);
      put<float>(bytes, 9.0F, big);
    }
    put<std::uint8_t>(bytes, 1, big);
    put<std::uint32_t>(bytes, 4, big);
    for (int index = 0; index < 4; ++index) {
      put<std::uint16_t>(bytes, static_cast<std::uint16_t>(index), big);
    }
    put<std::uint8_t>(bytes, 0, big);
    put<std::int32_t>(bytes, 3, big);
    const auto model = readBytes(bytes);
    ASSERT_TRUE(model) << describe(model.error());
    EXPECT_EQ(model->mesh.vertices, readBytes(kSquare)->mesh.vertices);
    EXPECT_EQ(model->mesh.faces, (std::vector<Eigen::Vector3i>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(equal(model->colors.at(2), {255, 128, 0}));
    EXPECT_EQ(model->comments, std::vector<std::string>{"by a test"});
  }
}

TEST_F(Ply, FansPolygonsAndLeavesOutLinesAndPoints) {
  std::string text = kSquareHeader + "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n";
  text.replace(text.find("element face 2"), 14, "element face 4");
  const auto model = readBytes(text + "1 2\n4 0 1 2 3\n2 0 1\n0\n");
  ASSERT_TRUE(model) << describe(model.error());
  EXPECT_EQ(model->mesh.faces, (std::vector<Eigen::Vector3i>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(Ply, RefusesWhatIsNoMesh) {
  EXPECT_EQ(codeOf(""), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("solid cube\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nend_header\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nend_header\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat sideways 1.0\nend_header\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nelement vertex\nend_header\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nelement vertex -4\nend_header\n"),
            ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nproperty float x\nend_header\n"),
            ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n"),
            ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
            ErrorCode::MeshInvalid);  // no y and z
}

TEST_F(Ply, RefusesPointsAlone) {
  std::string text = kSquareHeader;
  text.replace(text.find("element face 2"), 14, "element face 0");
  const auto model = readBytes(text + "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n");
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::MeshInvalid);
  EXPECT_NE(model.error().detail.find("no faces"), std::string::npos);
}

TEST_F(Ply, RefusesFacesThatNameNoVertex) {
  const std::string vertices = kSquareHeader + "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n";
  EXPECT_EQ(codeOf(vertices + "3 0 1 2\n3 0 2 4\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf(vertices + "3 0 1 2\n3 0 2 -1\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf(vertices + "3 0 1 2\n3 0 2 9999999999\n"), ErrorCode::MeshInvalid);
  EXPECT_EQ(codeOf(vertices + "3 0 1 2\n3 0 2 nan\n"), ErrorCode::MeshInvalid);
}

TEST_F(Ply, RefusesPlacesThatAreNotFinite) {
  const std::string faces = "3 0 1 2\n3 0 2 3\n";
  for (const char* bad : {"nan", "inf", "-inf", "1e39"}) {
    EXPECT_EQ(codeOf(kSquareHeader + "0 0 0\n1 0 " + bad + "\n1 1 0\n0 1 0.5\n" + faces),
              ErrorCode::MeshInvalid)
        << bad;
  }
}

TEST_F(Ply, ANegativeSigmaIsRefusedAndANormalWithoutLengthIsNot) {
  TexturedMesh model = makeModel(makeCube(10.0));
  model.mesh.normals[2] = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  ASSERT_TRUE(writePly(folder_.path() / "a.ply", model));
  const auto read = readPly(folder_.path() / "a.ply");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.normals[2], Eigen::Vector3f::Zero());

  model.sigma_mm[5] = -0.1F;
  ASSERT_TRUE(writePly(folder_.path() / "a.ply", model));
  EXPECT_EQ(readPly(folder_.path() / "a.ply").error().code, ErrorCode::MeshInvalid);
}

TEST_F(Ply, ACountThatTheFileCannotHoldIsAnErrorNotALackOfMemory) {
  for (const char* count : {"5", "4000000000", "18446744073709551615"}) {
    std::string text = kSquare;
    text.replace(text.find("vertex 4"), 8, std::string("vertex ") + count);
    EXPECT_EQ(codeOf(text), ErrorCode::FileUnreadable) << count;
    text = kSquare;
    text.replace(text.find("face 2"), 6, std::string("face ") + count);
    EXPECT_EQ(codeOf(text), ErrorCode::FileUnreadable) << count;
  }
  std::string text = kSquare;
  text.replace(text.find("vertex 4"), 8, "vertex 18446744073709551616");
  EXPECT_EQ(codeOf(text), ErrorCode::MeshInvalid);  // no number at all
}

TEST_F(Ply, ARowlessElementCostsNothing) {
  std::string text = kSquare;
  text.insert(text.find("element vertex"), "element nothing 18446744073709551615\n");
  EXPECT_TRUE(readBytes(text));
}

TEST_F(Ply, AListThatTheFileCannotHoldIsAnError) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
  bytes += std::string(12, '\0') + "\xFF\xFF\xFF\xFF" + std::string(12, '\0');
  EXPECT_EQ(codeOf(bytes), ErrorCode::FileUnreadable);
}

TEST_F(Ply, MissingFilesAndFoldersAreTwoErrors) {
  EXPECT_EQ(readPly(folder_.path() / "none.ply").error().code, ErrorCode::FileMissing);
  EXPECT_EQ(readPly(folder_.path()).error().code, ErrorCode::FileUnreadable);
}

TEST_F(Ply, ErrorsNameTheFile) {
  const auto read = readBytes("nonsense");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().detail.find("in.ply"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
