// A visit from first run to countersignature, backup and recomputation, by the command line alone.
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CliRecords : public ::testing::Test {
 protected:
  void SetUp() override {
    write("admin", "first administrator\n");
    write("nurse", "nurse's own words\n");
    write("doctor", "doctor's own words\n");
    const json created = done("anna", "admin", "store create");
    recovery_code_ = created.value("recovery_code", "");
    done("anna", "admin", "user add nina --role nurse --new-password-file " + file("nurse"));
    done("anna", "admin", "user add paul --role physician --new-password-file " + file("doctor"));
    const test::Skin skin = test::sphereSkin(44.0);
    const test::Relief relief = test::bowl(8.0, 3.0);
    ASSERT_TRUE(writePly(file("model.ply"),
                         test::woundMesh(skin, relief, {.half_size_mm = 34.0, .edge_mm = 0.8})));
    json points = json::array();
    for (const Eigen::Vector3d& p : test::circleOn(skin, relief, 8.2, 17)) {
      points.push_back({p.x(), p.y(), p.z()});
    }
    write("outline.json",
          json{{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"points", points}}.dump());
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
  }
  /// @param password  the file that holds it
  [[nodiscard]] CliRun as(const std::string& user,
                          const std::string& password,
                          const std::string& arguments,
                          const std::string& store = "records") const {
    return cli(arguments + " --store " + file(store) + " --user " + user + " --password-file " +
               file(password) + " --json " + file("result.json"));
  }
  /// What a command that must go well gives.
  json done(const std::string& user,
            const std::string& password,
            const std::string& arguments,
            const std::string& store = "records") const {
    const CliRun run = as(user, password, arguments, store);
    EXPECT_EQ(run.exit_code, 0) << arguments << ": " << run.output;
    return json::parse(std::ifstream(file("result.json")), nullptr, false);
  }
  json nurse(const std::string& arguments) const { return done("nina", "nurse", arguments); }
  /// The sentence of a command that must fail.
  [[nodiscard]] std::string refused(const std::string& user,
                                    const std::string& password,
                                    const std::string& arguments) const {
    const CliRun run = as(user, password, arguments);
    EXPECT_EQ(run.exit_code, 1) << arguments << ": " << run.output;
    return run.output;
  }
  /// A measured draft. @return its id
  std::string measuredVisit() const {
    const std::string patient =
        nurse("patient add --family Müller --given Jürgen --born 1950-02-03").value("id", "");
    const std::string foot = nurse("patient foot " + patient + " --side right").value("id", "");
    const std::string wound =
        nurse("wound add " + foot + " --place heel --aspect plantar").value("id", "");
    const std::string visit =
        nurse("visit add " + wound + " --at 2026-10-05T09:30 --set abi=0.9").value("id", "");
    nurse("visit measure " + visit + " " + file("model.ply") + " --outline " +
          file("outline.json"));
    return visit;
  }

  TemporaryFolder folder_;
  std::string recovery_code_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(CliRecords, AVisitGoesFromDraftToCountersigned) {
  const std::string visit = measuredVisit();
  const json measured = nurse("visit show " + visit).at("measurements").at(0).at("numbers");
  ASSERT_EQ(cli("measure " + file("model.ply") + " --outline " + file("outline.json") +
                " --quiet --json " + file("plain.json"))
                .exit_code,
            0);
  EXPECT_EQ(measured, json::parse(std::ifstream(file("plain.json"))));
  nurse("visit sign " + visit);
  EXPECT_TRUE(contains(refused("nina", "nurse", "visit edit " + visit + " --set abi=1"), "reason"));
  nurse("visit amend " + visit + " --set abi=1 --reason \"cuff was loose\"");
  EXPECT_EQ(done("paul", "doctor", "visit list").at("visits").size(), 1U);
  EXPECT_TRUE(contains(refused("nina", "nurse", "visit review " + visit), "role"));
  done("paul", "doctor", "visit review " + visit);
  EXPECT_EQ(done("paul", "doctor", "visit list").at("visits").size(), 0U);
  const json versions = nurse("visit show " + visit).at("versions");
  EXPECT_EQ(versions.back().at("state"), "reviewed");
  EXPECT_EQ(versions.front().at("fields").at("abi"), 0.9);  // earlier values stay
  EXPECT_EQ(versions.back().at("fields").at("abi"), 1);
  EXPECT_EQ(done("anna", "admin", "audit verify").at("findings").size(), 0U);
}

TEST_F(CliRecords, ABackupRecomputesToTheSameBits) {
  const std::string visit = measuredVisit();
  EXPECT_EQ(nurse("recompute " + visit).at("same"), true);
  done("anna", "admin", "backup " + file("copy"));
  ASSERT_EQ(cli("restore " + file("copy") + " --store " + file("again")).exit_code, 0);
  const json again = done("nina", "nurse", "recompute " + visit, "again");
  EXPECT_EQ(again.at("same"), true);
  EXPECT_EQ(again.at("differences").size(), 0U);
}

std::string textOf(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST_F(CliRecords, AnExportIsWholeAndNamesItsFiles) {
  const std::string visit = measuredVisit();
  nurse("export " + file("all"));
  for (const char* name : {"patients.csv",
                           "wounds.csv",
                           "visits.csv",
                           "measurements.csv",
                           "records.json",
                           "manifest.json"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "all" / name)) << name;
  }
  const fs::path files = folder_.path() / "all" / "visits" / visit;
  for (const char* name : {"model.ply", "model.stl", "model.obj", "outline.json"}) {
    EXPECT_TRUE(fs::exists(files / name)) << name;
  }
  EXPECT_EQ(textOf(files / "model.ply"), textOf(file("model.ply")));  // to the bit
  EXPECT_TRUE(contains(textOf(folder_.path() / "all" / "patients.csv"), "Müller"));
  EXPECT_TRUE(contains(textOf(folder_.path() / "all" / "measurements.csv"), "opening_area_mm2"));
  const json manifest = json::parse(std::ifstream(folder_.path() / "all" / "manifest.json"));
  EXPECT_EQ(manifest.at("files").size(), 9U);
  EXPECT_TRUE(contains(refused("nina", "nurse", "export " + file("all")), "there already"));
  nurse("export " + file("one.zip") + " --visit " + visit + " --no-models");
  EXPECT_EQ(textOf(file("one.zip")).substr(0, 2), "PK");
}

TEST_F(CliRecords, APseudonymisedExportNamesNobody) {
  const std::string visit = measuredVisit();
  nurse("visit edit " + visit + " --set \"notes=Mrs Müller from the mill\"");
  nurse("export " + file("research") + " --pseudonymised");
  for (const auto& entry : fs::recursive_directory_iterator(file("research"))) {
    if (entry.is_regular_file() && entry.path().filename() != "model.stl" &&
        entry.path().filename() != "model.ply") {  // bytes, in which any four letters may stand
      const std::string text = textOf(entry.path());
      for (const std::string& secret :
           {std::string("üller"), std::string("1950-02"), std::string("2026-10"), visit}) {
        EXPECT_FALSE(contains(text, secret)) << entry.path() << " names " << secret;
      }
    }
  }
  const std::string numbers = textOf(folder_.path() / "research" / "measurements.csv");
  EXPECT_TRUE(contains(numbers, "2000-01-01"));
  EXPECT_TRUE(contains(numbers, "volume_mm3"));
}

TEST_F(CliRecords, DamageToWhatIsKeptIsNamed) {
  const std::string visit = measuredVisit();
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / "records" / "files")) {
    if (entry.is_regular_file()) {
      std::fstream stored(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
      stored.seekp(200);
      stored.put('x');
    }
  }
  EXPECT_TRUE(contains(refused("nina", "nurse", "recompute " + visit), "restore"));
  EXPECT_TRUE(contains(refused("anna", "admin", "audit verify"), "file"));
}

TEST_F(CliRecords, NobodyReadsWithoutThePassword) {
  write("guess", "123456789\n");
  EXPECT_TRUE(contains(refused("nina", "guess", "patient list"), "wrong"));
  EXPECT_TRUE(contains(refused("nobody", "guess", "patient list"), "wrong"));
  EXPECT_TRUE(contains(refused("anna", "admin", "patient add --family A --given B"), "role"));
  EXPECT_EQ(cli("patient list --store " + file("records")).exit_code, 2);
  EXPECT_TRUE(contains(
      cli("patient list --user a --password-file " + file("admin") + " --store " + file("nowhere"))
          .output,
      "store create"));
  EXPECT_FALSE(fs::exists(file("nowhere")));
}

TEST_F(CliRecords, TheRecoveryCodeOpensAForgottenAccount) {
  measuredVisit();
  write("code", recovery_code_ + "\n");
  write("new", "something new\n");
  done("nina", "new", "store reset-password --recovery-code-file " + file("code"));
  EXPECT_EQ(done("nina", "new", "patient list müll").at("patients").size(), 1U);
  EXPECT_TRUE(contains(refused("nina", "nurse", "patient list"), "wrong"));
}

TEST_F(CliRecords, WhatWasFiledWronglyIsMovedAndMerged) {
  const std::string visit = measuredVisit();
  const std::string other = nurse("patient add --family Muller --given Juergen").value("id", "");
  const std::string foot = nurse("patient foot " + other + " --side left").value("id", "");
  const std::string wound =
      nurse("wound add " + foot + " --place toe_1 --aspect plantar").value("id", "");
  nurse("visit move " + visit + " " + wound + " --reason \"wrong foot\"");
  EXPECT_EQ(nurse("patient show " + other).at("visits").size(), 1U);
  const json all = nurse("patient list");
  ASSERT_EQ(all.at("patients").size(), 2U);
  const json first = all.at("patients").at(0);
  const std::string kept =
      first.at("id") == other ? all.at("patients").at(1).value("id", "") : first.value("id", "");
  done("anna", "admin", "patient merge " + kept + " " + other + " --reason \"same person\"");
  EXPECT_EQ(nurse("patient list").at("patients").size(), 1U);
  EXPECT_EQ(nurse("patient show " + kept).at("visits").size(), 1U);
  nurse("visit trash " + visit);
  EXPECT_EQ(nurse("patient show " + kept).at("visits").size(), 0U);
  nurse("visit untrash " + visit);
  EXPECT_EQ(nurse("patient show " + kept).at("visits").size(), 1U);
}

TEST_F(CliRecords, AVisitWithoutAScanHoldsTypedValuesAndAPhotograph) {
  const std::string patient = nurse("patient add --family A --given B").value("id", "");
  const std::string foot =
      nurse("patient foot " + patient + " --side left --missing-toes 4,5").value("id", "");
  const std::string wound =
      nurse("wound add " + foot + " --place mth_1 --aspect plantar").value("id", "");
  EXPECT_TRUE(contains(refused("nina", "nurse", "visit add " + wound + " --no-scan"), "ruler"));
  write("photo.jpg", "\xff\xd8\xff\xe0 a picture");
  const json visit = nurse("visit add " + wound + " --no-scan --set ruler_length_mm=12 --picture " +
                           file("photo.jpg"));
  EXPECT_EQ(visit.at("usable_scan"), false);
  EXPECT_EQ(visit.at("files").at(0).at("title"), "photo.jpg");
  EXPECT_TRUE(
      contains(refused("nina", "nurse", "visit add " + wound + " --set abi=12"), "abi"));  // a slip
}

}  // namespace
}  // namespace tarsus
