#include "app/cli/demo_history.h"

#include "app/cli/qt_session.h"
#include "app/version.h"
#include "measurement/records/history.h"
#include "measurement/records/sign_in.h"
#include "measurement/records/users.h"
#include "measurement/records/visit_measurement.h"
#include "measurement/report/visit_report.h"
#include "reconstruction/base/temporary_folder.h"

#include <memory>
#include <string>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::int64_t kWeek_ms = std::int64_t{7} * 86'400'000;
constexpr std::int64_t kFirstVisit_ms = 1'788'595'200'000;  // 5 September 2026, 8 o'clock
constexpr const char* kNurse = "nurse";
constexpr const char* kPassword = "demonstration";

/// The records' clock stands where the demonstration says, so that it prints the same each time.
struct Clock {
  std::shared_ptr<std::int64_t> now_ms = std::make_shared<std::int64_t>(kFirstVisit_ms);
  [[nodiscard]] ClockMs function() const {
    return [now = now_ms] { return *now; };
  }
};

WoundFields woundOf(FootCase foot) {
  WoundFields fields{.place = "mth_2",
                     .aspect = "plantar",
                     .onset = "2026-08-20",
                     .aetiology = "neuropathic",
                     .parents = {},
                     .healed_on = {}};
  switch (foot) {
    case FootCase::Heel:
      fields.place = "heel";
      break;
    case FootCase::Lateral:
      fields.place = "mth_5";
      fields.aspect = "lateral";
      break;
    case FootCase::Two:
      fields.place = "mth_1";
      break;
    case FootCase::Forefoot:
      break;
  }
  return fields;
}

json formOf(int weeks) {
  json form{{"abi", 0.95},
            {"monofilament_felt_of_10", 4},
            {"exudate_amount", weeks == 0 ? "moderate" : "light"},
            {"exudate_type", "serous"},
            {"edge", weeks == 0 ? "punched_out" : "sloping"},
            {"offloading", weeks == 0 ? "removable walker" : "total contact cast"},
            {"notes", "Invented for the demonstration."}};
  if (weeks == 0) {
    form["debridement"] = "before_scan";
  }
  return form;
}

/// @return the wound's id
Expected<std::string> makePatient(Store& store, FootCase foot) {
  return addPatient(store,
                    {.family_name = "Example",
                     .given_name = "Erika",
                     .birth_date = "1953-04-12",
                     .identifier = "DEMO-1"})
      .and_then([&](const Patient& patient) {
        return addFoot(store,
                       patient.id,
                       {.side = FootSide::Right, .missing_toes = {}, .forefoot_missing = false});
      })
      .and_then([&](const Foot& added) { return addWound(store, added.id, woundOf(foot)); })
      .map([](const Wound& wound) { return wound.id; });
}

/// @return the visit's id
Expected<std::string> fileVisit(Store& store,
                                const std::string& wound,
                                const DemoVisit& visit,
                                std::int64_t at_ms) {
  return addVisit(store,
                  wound,
                  {.taken_at_ms = at_ms,
                   .usable_scan = true,
                   .fields = formOf(visit.weeks),
                   .files = {}})
      .and_then([&](const Visit& added) {
        return measureVisit(store, added.id, added.revision, visit.files, TARSUS_VERSION);
      })
      .and_then([&](const Measurement& measured) { return findVisit(store, measured.visit_id); })
      .and_then([&](const Visit& measured) {
        return stepVisit(store, measured.id, measured.revision, VisitStep::Sign);
      })
      .map([](const Visit& done) { return done.id; });
}

Expected<void> signInAsNurse(Store& store) {
  return firstRun(store, "administrator", kPassword)
      .and_then([&](const std::string&) { return addUser(store, kNurse, Role::Nurse, kPassword); })
      .and_then([&](const User&) { return signIn(store, kNurse, kPassword); })
      .map([](const SignedIn&) {});
}

}  // namespace

Expected<json> demoHistory(const fs::path& out,
                           FootCase foot,
                           const std::vector<DemoVisit>& visits,
                           const Job& job) {
  startQt();
  const fs::path records = out / "demo_records";
  std::error_code ignored;
  fs::remove_all(records, ignored);  // of an earlier demonstration
  const Clock clock;
  auto store = Store::open({.folder = records, .postgres = std::nullopt},
                           {.now_ms = clock.function(),
                            .station = "demonstration",
                            .idle_ms = std::nullopt,
                            .key_cost = {}});
  if (!store) {
    return tl::unexpected(store.error());
  }
  if (auto ready = signInAsNurse(*store); !ready) {
    return tl::unexpected(ready.error());
  }
  const auto wound = makePatient(*store, foot);
  if (!wound) {
    return tl::unexpected(wound.error());
  }
  std::string last;
  for (const DemoVisit& visit : visits) {
    *clock.now_ms = kFirstVisit_ms + visit.weeks * kWeek_ms;
    const auto filed = fileVisit(*store, *wound, visit, *clock.now_ms);
    if (!filed) {
      return tl::unexpected(filed.error());
    }
    last = *filed;
  }
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return fail(ErrorCode::FileUnwritable, "no temporary folder could be made; set TMPDIR");
  }
  const auto content = visitReport(*store, last, folder.path(), {.version = TARSUS_VERSION}, job);
  if (!content) {
    return tl::unexpected(content.error());
  }
  if (auto written = writeReport(out / "report_history.pdf", *content); !written) {
    return tl::unexpected(written.error());
  }
  json result = content->comparison ? toJson(content->comparison->result) : json::object();
  result["records"] = records.string();
  result["report"] = (out / "report_history.pdf").string();
  return result;
}

}  // namespace tarsus
