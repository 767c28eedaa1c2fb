#include "measurement/phantom/phantom_kit.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/scene/stl.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class PhantomKit : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto written = writePhantomKit(folder_.path(), "1.2.3");
    ASSERT_TRUE(written);
    ASSERT_EQ(written->size(), 5U);
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] json facts() const {
    return json::parse(readTextFile(file("plate_flat.phantom.json")).value_or(""));
  }
  void expectRefused(const json& document, ErrorCode code, const std::string& word) const {
    ASSERT_TRUE(writeTextAtomically(file("plate_flat.phantom.json"), document.dump()));
    const auto phantom = readPhantom(file("plate_flat.phantom.json"));
    ASSERT_FALSE(phantom);
    EXPECT_EQ(phantom.error().code, code);
    EXPECT_NE(phantom.error().detail.find(word), std::string::npos) << phantom.error().detail;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(PhantomKit, ReadsBackWhatItWrote) {
  for (const PhantomDesign& design : phantomDesigns()) {
    const Phantom made = phantomOf(design);
    const auto read = readPhantom(file(design.name + ".phantom.json"));
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(read->name, design.name);
    EXPECT_EQ(read->stl_sha256, made.stl_sha256);
    EXPECT_EQ(read->mesh.faces.size(), made.mesh.faces.size());
    EXPECT_EQ(read->mesh.vertices.size(), made.mesh.vertices.size());
    ASSERT_EQ(read->wounds.size(), made.wounds.size());
    for (std::size_t i = 0; i < made.wounds.size(); ++i) {
      EXPECT_EQ(read->wounds[i].truth, made.wounds[i].truth);
      EXPECT_TRUE(read->wounds[i].outline_mm == made.wounds[i].outline_mm);
      EXPECT_TRUE(read->wounds[i].outline_normals == made.wounds[i].outline_normals);
      EXPECT_TRUE(read->wounds[i].skin_curve_mm == made.wounds[i].skin_curve_mm);
    }
  }
}

TEST_F(PhantomKit, TellsHowToPrintCheckScanAndVerify) {
  const std::string guide = readTextFile(file("PHANTOM.txt")).value_or("");
  for (const std::string word : {"matt",
                                 "caliper",
                                 "0.12 mm",
                                 "tarsus-cli verify",
                                 "foot_block",
                                 "plate_sphere_r30",
                                 "92.00",
                                 "80.00",
                                 "Not a medical device"}) {
    EXPECT_NE(guide.find(word), std::string::npos) << word;
  }
  const json facts_now = facts();
  EXPECT_EQ(facts_now.at("unit"), "mm");
  EXPECT_EQ(facts_now.at("version"), "1.2.3");
  EXPECT_EQ(facts_now.at("printing").at("control_distances").size(), 2U);
  EXPECT_EQ(facts_now.at("wounds").at(0).at("skin").at("form"), "plane");
  EXPECT_DOUBLE_EQ(facts_now.at("wounds").at(0).at("crater").at("wall_angle_degrees"), 45.0);
}

TEST_F(PhantomKit, WritesTheSameBytesAgain) {
  const std::string stl = readTextFile(file("foot_block.stl")).value_or("");
  const std::string facts_before = readTextFile(file("foot_block.phantom.json")).value_or("");
  ASSERT_TRUE(writeTextAtomically(file("notes.txt"), "mine"));
  ASSERT_TRUE(writePhantomKit(file("."), "1.2.3"));
  EXPECT_TRUE(readTextFile(file("foot_block.stl")) == stl);
  EXPECT_TRUE(readTextFile(file("foot_block.phantom.json")) == facts_before);
  EXPECT_EQ(readTextFile(file("notes.txt")).value_or(""), "mine");
}

TEST_F(PhantomKit, RefusesWhatIsNotItsOwn) {
  EXPECT_EQ(readPhantom(file("none.json")).error().code, ErrorCode::FileMissing);
  expectRefused(json::array(), ErrorCode::FileUnreadable, "phantom");
  expectRefused({{"points", {1, 2}}}, ErrorCode::FileUnreadable, "phantom");
}

TEST_F(PhantomKit, RefusesDamageAndOtherVersions) {
  const json whole = facts();
  json changed = whole;
  changed["format_version"] = 2;
  expectRefused(changed, ErrorCode::FileUnreadable, "another version");
  changed = whole;
  changed["wounds"] = json::array();
  expectRefused(changed, ErrorCode::FileUnreadable, "no wounds");
  for (const char* key : {"name", "stl", "stl_sha256", "wounds"}) {
    changed = whole;
    changed.erase(key);
    expectRefused(changed, ErrorCode::FileUnreadable, "damaged");
    changed[key] = 7;
    expectRefused(changed, ErrorCode::FileUnreadable, "damaged");
  }
  changed = whole;
  changed["wounds"][0]["true"]["volume_mm3"] = 0.0;
  expectRefused(changed, ErrorCode::FileUnreadable, "damaged");
  changed = whole;
  changed["wounds"][0]["outline"]["points"][3] = {1.0, "x", 2.0};
  expectRefused(changed, ErrorCode::FileUnreadable, "damaged");
}

TEST_F(PhantomKit, RefusesAnotherSurfaceThanTheOneDescribed) {
  const json whole = facts();
  std::string stl = readTextFile(file("plate_flat.stl")).value_or("");
  stl[5000] = static_cast<char>(stl[5000] ^ 1);
  ASSERT_TRUE(writeTextAtomically(file("plate_flat.stl"), stl));
  expectRefused(whole, ErrorCode::FileUnreadable, "not the surface");
  fs::remove(file("plate_flat.stl"));
  expectRefused(whole, ErrorCode::FileMissing, "plate_flat.stl");
}

TEST_F(PhantomKit, SaysWhenTheFolderCannotBeWritten) {
  const auto written = writePhantomKit(file("plate_flat.stl"), "1");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
}

}  // namespace
}  // namespace tarsus
