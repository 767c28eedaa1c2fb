// Reports of visits as the store keeps them: who did what, what was amended, and visits without a
// usable scan.
#include "measurement/report/visit_report.h"

#include "measurement/records/removal.h"
#include "measurement/records/visit_measurement.h"
#include "reconstruction/scene/ply.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/records/record_test.h"
#include "tests/measurement/report/printed_page.h"

#include <QImage>

#include <nlohmann/json.hpp>

#include <fstream>
#include <numeric>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr std::int64_t kDay_ms = 86'400'000;

class VisitReport : public RecordTest {
 protected:
  void SetUp() override {
    RecordTest::SetUp();
    store_.emplace(openAs("nils"));
    physician_.emplace(openAs("petra", "ward 2"));
    wound_ = addWounded(*store_, "Berg").wound.id;
    const test::Skin skin = test::sphereSkin(44.0);
    const test::Relief relief = test::bowl(8.0, 3.0);
    must(writePly(folder_.path() / "model.ply",
                  test::woundMesh(skin, relief, {.half_size_mm = 30.0, .edge_mm = 1.2})));
    for (const double radius_mm : {8.2, 9.4}) {
      json points = json::array();
      for (const Eigen::Vector3d& p : test::circleOn(skin, relief, radius_mm, 17)) {
        points.push_back({p.x(), p.y(), p.z()});
      }
      const auto written = writeSource(
          radius_mm < 9.0 ? "outline.json" : "wider.json",
          json{{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"points", points}}.dump());
      ASSERT_FALSE(written.empty());
    }
  }
  std::string addDraft(const VisitContent& content) {
    return must(addVisit(*store_, wound_, content)).id;
  }
  void measure(Store& store,
               const std::string& visit,
               const char* outline,
               const char* reason = "") {
    *now_ms_ += 1000;
    must(measureVisit(store,
                      visit,
                      must(findVisit(store, visit)).revision,
                      {.model = folder_.path() / "model.ply", .outline = folder_.path() / outline},
                      "test",
                      reason));
  }
  void step(Store& store, const std::string& visit, VisitStep what, const char* reason = "") {
    *now_ms_ += 60'000;
    must(stepVisit(store, visit, must(findVisit(store, visit)).revision, what, reason));
  }
  /// Changes the visit's content.
  template <typename Edit>
  void edit(Store& store, const std::string& visit, const char* reason, Edit change) {
    *now_ms_ += 60'000;
    Visit now = must(findVisit(store, visit));
    change(now.content);
    must(editVisit(store, visit, now.revision, now.content, reason));
  }
  VisitFile kept(const std::string& name, const std::string& bytes) {
    return {.role = "picture",
            .name = must(store_->files().put(store_->vault(), writeSource(name, bytes))),
            .title = name};
  }
  ReportContent report(const std::string& visit,
                       ReportLanguage language = ReportLanguage::English) {
    const TemporaryFolder opened;
    return must(
        visitReport(*store_, visit, opened.path(), {.language = language, .version = "0.0.0"}));
  }
  std::string printed(const ReportContent& content) {
    const auto path = folder_.path() / "report.pdf";
    must(writeReport(path, content));
    const auto pages = pageTexts(path);
    return std::accumulate(pages.begin(), pages.end(), std::string());
  }

  std::optional<Store> store_;      ///< of nils, a nurse
  std::optional<Store> physician_;  ///< of petra
  std::string wound_;
};
INSTANTIATE_TEST_SUITE_P(, VisitReport, testing::Values(Database::Engine::Sqlite), engineName);

void expectText(const std::string& text, const std::vector<std::string>& wanted) {
  for (const std::string& words : wanted) {
    EXPECT_NE(text.find(words), std::string::npos) << "missing: " << words << "\nin: " << text;
  }
}

TEST_P(VisitReport, MeasuringAgainAfterSigningIsOneAmendmentWithOldAndNewNumbers) {
  const std::string visit = addDraft(sampleVisit(*now_ms_, "seen"));
  measure(*store_, visit, "outline.json");
  measure(*store_, visit, "outline.json");  // still a draft: no amendment
  step(*store_, visit, VisitStep::Sign);
  measure(*physician_, visit, "wider.json", "the outline left out the rim");
  const ReportContent content = report(visit);
  ASSERT_EQ(content.amendments.size(), 1U);
  const ReportAmendment& amendment = content.amendments.front();
  ASSERT_TRUE(amendment.measured && amendment.measured->before);
  EXPECT_TRUE(amendment.changes.empty());
  EXPECT_LT(*amendment.measured->before->opening_area_mm2,
            *amendment.measured->now.opening_area_mm2);
  EXPECT_EQ(*amendment.measured->now.opening_area_mm2, *content.measurement.opening_area_mm2);
  EXPECT_EQ(amendment.who, "petra");
  ASSERT_EQ(content.signatures.size(), 1U);
  EXPECT_EQ(content.signatures.front().who, "nils");
  const std::string english = printed(content);
  expectText(english,
             {"Amendment 1. Area, opening: 2.", "Volume below skin: ", "Depth, greatest: "});
  expectText(english, {"Reason: the outline left out the rim.", "(1 amendment)"});
  ReportContent german = content;
  german.language = ReportLanguage::German;
  expectText(printed(german), {"Nachtrag 1. Fläche der Öffnung: 2,", "Größte Tiefe: "});
}

TEST_P(VisitReport, OnlyWhatHappenedStandsAmongTheSignatures) {
  const std::string visit = addDraft(sampleVisit(*now_ms_, "seen"));
  measure(*store_, visit, "outline.json");
  step(*store_, visit, VisitStep::Sign);
  edit(*store_, visit, "cuff was loose", [](VisitContent& content) {
    content.fields["abi"] = 1.1;
    content.fields["exudate_amount"] = "heavy";
  });
  must(moveToTrash(
      *store_, RecordKind::Visit, visit, must(findVisit(*store_, visit)).revision, "wrong visit"));
  must(takeFromTrash(*store_, RecordKind::Visit, visit, must(findVisit(*store_, visit)).revision));
  step(*physician_, visit, VisitStep::Return, "which toe?");
  edit(*store_, visit, "toe added", [](VisitContent& content) {
    content.fields["plan"] = "second toe";
  });
  step(*physician_, visit, VisitStep::Review);
  const ReportContent content = report(visit);
  ASSERT_EQ(content.signatures.size(), 3U);
  EXPECT_EQ(content.signatures[0].step, SignatureStep::Signed);
  EXPECT_EQ(content.signatures[1].step, SignatureStep::Returned);
  EXPECT_EQ(content.signatures[1].reason, "which toe?");
  EXPECT_EQ(content.signatures[2].step, SignatureStep::Countersigned);
  ASSERT_EQ(content.amendments.size(), 2U);
  EXPECT_EQ(content.amendments[0].changes.size(), 2U);
  const std::string text = printed(content);
  expectText(text, {"(2 amendments)", "ankle-brachial index: 0.9 → 1.1; exudate: light → heavy"});
  expectText(text, {"Amendment 2. plan: not recorded → second toe. Reason: toe added."});
  expectText(text, {"returned for a change. Reason: which toe?"});
  ReportContent french = content;
  french.language = ReportLanguage::French;
  expectText(printed(french), {"0,9 → 1,1", "faible → abondant"});
}

TEST_P(VisitReport, DateScanFlagWoundAndPicturesAreAmendedInWords) {
  const std::string visit = addDraft(sampleVisit(*now_ms_, "seen"));
  measure(*store_, visit, "outline.json");
  step(*store_, visit, VisitStep::Sign);
  edit(*store_, visit, "wrong day", [&](VisitContent& content) {
    content.taken_at_ms -= kDay_ms;
    content.usable_scan = false;
    content.fields["ruler_length_mm"] = 22.0;
    content.files.push_back(kept("foot.txt", "no picture"));
  });
  const ReportContent content = report(visit);
  ASSERT_EQ(content.amendments.size(), 1U);
  expectText(printed(content),
             {"time of the visit: 1 Jan 2026 00:00 UTC → 31 Dec 2025 00:00 UTC",
              "usable scan: yes → no",
              "length by ruler, mm: not recorded → 22",
              "pictures: not recorded → foot.txt"});
}

TEST_P(VisitReport, NotesCarryWhoWroteThemAndTheScanWhoMadeIt) {
  const std::string visit = addDraft(sampleVisit(*now_ms_, "seen"));
  const std::string written = "2026-01-01T00:00:00Z";
  measure(*store_, visit, "outline.json");
  edit(*physician_, visit, "", [](VisitContent& content) { content.fields["plan"] = "cast"; });
  step(*physician_, visit, VisitStep::Sign);
  edit(*physician_, visit, "cuff", [](VisitContent& content) { content.fields["abi"] = 1.0; });
  const ReportContent content = report(visit);
  EXPECT_EQ(content.notes.who, "nils");
  EXPECT_EQ(content.notes.when, written);
  EXPECT_EQ(content.plan.who, "petra");
  EXPECT_EQ(content.record->scanned_by, "nils");
}

std::string pictureBytes(const std::filesystem::path& path, const char* format) {
  QImage image(64, 48, QImage::Format_RGB32);
  image.fill(QColor(200, 40, 40));
  EXPECT_TRUE(image.save(QString::fromStdString(path.string()), format));
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_P(VisitReport, AVisitWithoutAUsableScanPrintsWhatWasTyped) {
  const std::string first = addDraft(sampleVisit(*now_ms_, "seen"));
  measure(*store_, first, "outline.json");
  *now_ms_ += 7 * kDay_ms;
  VisitContent typed{
      .taken_at_ms = *now_ms_,
      .usable_scan = false,
      .fields = {{"ruler_length_mm", 22.0}, {"ruler_width_mm", 15.5}, {"probe_depth_mm", 4.0}}};
  typed.files = {kept("foot.jpg", pictureBytes(folder_.path() / "a.jpg", "JPG")),
                 kept("foot.png", pictureBytes(folder_.path() / "a.png", "PNG")),
                 kept("letter.pdf", "%PDF-1.4 no picture")};
  const std::string second = addDraft(typed);
  const ReportContent content = report(second);
  EXPECT_TRUE(content.no_scan);
  EXPECT_EQ(content.photographs.size(), 2U);
  ASSERT_EQ(content.visits.size(), 2U);
  const std::string text = printed(content);
  expectText(text,
             {"2 of 2", "No usable scan.", "typed, by ruler", "typed, by probe", "22.0 × 15.5"});
  expectText(text, {"not measurable: no usable scan", "Photograph: foot.jpg", "n. m."});
  expectText(text, {"Left out, as they are no JPEG or PNG pictures: letter.pdf."});
  for (const char* never : {"The foot was reconstructed", "Fit for measurement", "Whole model"}) {
    EXPECT_EQ(text.find(never), std::string::npos) << never;
  }
  for (const ReportLanguage language : kReportLanguages) {
    ReportContent said = content;
    said.language = language;
    const std::string page = printed(said);
    EXPECT_EQ(language != ReportLanguage::English && page.find("usable") != std::string::npos &&
                  language != ReportLanguage::Spanish && language != ReportLanguage::French,
              false)
        << static_cast<int>(language);
  }
  ReportContent form = content;
  form.form = ReportForm::Bedside;
  expectText(printed(form), {"No usable scan.", "page 1/1"});

  // The next visit's history holds it, as what cannot be measured, and is laid on the first.
  *now_ms_ += 7 * kDay_ms;
  const std::string third = addDraft(sampleVisit(*now_ms_, "seen"));
  measure(*store_, third, "outline.json");
  const ReportContent later = report(third);
  ASSERT_EQ(later.visits.size(), 3U);
  EXPECT_FALSE(later.visits[1].measurement.not_measurable.empty());
  ASSERT_TRUE(later.comparison);
  EXPECT_EQ(later.comparison->earlier_visit, 1);
  expectText(printed(later), {"3 of 3", "n. m.", "visit 1 (1 Jan 2026 (draft)) with visit 3"});
}

TEST_P(VisitReport, AMeasuredVisitMarkedAsUnusablePrintsNoNumberOfItsScan) {
  VisitContent content = sampleVisit(*now_ms_, "seen");
  content.fields["ruler_length_mm"] = 17.0;
  const std::string visit = addDraft(content);
  measure(*store_, visit, "outline.json");
  edit(*store_, visit, "", [](VisitContent& now) { now.usable_scan = false; });
  const ReportContent report_content = report(visit);
  EXPECT_FALSE(report_content.measurement.opening_area_mm2);
  EXPECT_TRUE(report_content.model_sha256.empty());
  const std::string text = printed(report_content);
  expectText(text, {"not measurable: no usable scan", "No photograph was kept"});
  EXPECT_EQ(text.find("cm²"), std::string::npos);
}

TEST_P(VisitReport, AUsableScanThatNobodyMeasuredIsRefusedWithWhatToDo) {
  const std::string visit = addDraft(sampleVisit(*now_ms_, "seen"));
  const TemporaryFolder opened;
  const auto refused = visitReport(*store_, visit, opened.path(), {});
  expectFails(refused, ErrorCode::RecordMissing);
  expectText(describe(refused.error()), {"measure it"});
}

}  // namespace
}  // namespace tarsus
