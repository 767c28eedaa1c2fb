#include "ui/work/visit_work.h"

#include "measurement/records/visit_fields.h"
#include "ui/work/session.h"

#include <algorithm>
#include <fstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
constexpr int kSoon_ms = 400;
constexpr const char* kNoScan = "no-scan";

}  // namespace

VisitWork::VisitWork(Session& session, QObject* parent) : QObject(parent), session_(session) {
  soon_.setSingleShot(true);
  soon_.setInterval(kSoon_ms);
  connect(&soon_, &QTimer::timeout, this, &VisitWork::save);
  connect(&build_, &ScanBuild::scanBrought, this, [this] {
    has_scan_ = true;
    emit scanChanged();
  });
}

bool VisitWork::mayEdit() const {
  return open_ && session_.mayEdit() && facts_.visit.state == VisitState::Draft;
}

void VisitWork::open(const QString& visit_id) {
  if (open_ && facts_.visit.id == visit_id.toStdString()) {
    save();
  } else {
    close();
  }
  wanted_ = visit_id;
  session_.ask<VisitFacts>(
      Session::Kind::Read,
      this,
      [id = visit_id.toStdString()](Store& store) { return visitFacts(store, id); },
      [this, visit_id](Expected<VisitFacts> facts) {
        if (wanted_ != visit_id) {
          return;
        }
        if (!facts) {
          emit refused(facts.error());
          return;
        }
        adopt(std::move(*facts));
      });
}

void VisitWork::adopt(VisitFacts facts) {
  const bool same = open_ && facts_.visit.id == facts.visit.id;
  facts_ = std::move(facts);
  before_ = facts_.visit.content.fields;
  if (same && soon_.isActive()) {
    open_ = true;  // what was typed while it was read stands
  } else {
    now_ = before_;
  }
  open_ = true;
  std::error_code ignored;
  no_scan_ = !facts_.visit.content.usable_scan || fs::exists(folder() / kNoScan, ignored);
  has_scan_ = !scanIn(folder()).empty();
  if (!same && has_scan_ && mayEdit()) {
    build_.start(folder());
  }
  emit opened();
}

void VisitWork::close() {
  if (open_) {
    save();
    build_.clear();
  }
  wanted_.clear();
  open_ = false;
  saving_ = false;
  has_scan_ = false;
  no_scan_ = false;
  facts_ = {};
  before_ = now_ = sent_ = nlohmann::json::object();
}

void VisitWork::setField(const std::string& name, const nlohmann::json& value) {
  const auto found = now_.find(name);
  if (!mayEdit() || (found == now_.end() ? value.is_null() : *found == value)) {
    return;
  }
  if (value.is_null()) {
    now_.erase(name);
  } else {
    now_[name] = value;
  }
  soon_.start();
  emit fieldChanged(QString::fromStdString(name));
}

bool VisitWork::hasTypedMeasure() const {
  return std::ranges::any_of(visitFields(), [this](const VisitField& field) {
    return field.is_typed_measure && now_.contains(std::string(field.name));
  });
}

void VisitWork::setNoScan(bool no_scan) {
  if (!mayEdit() || no_scan_ == no_scan) {
    return;
  }
  no_scan_ = no_scan;
  // The records take a visit without a scan only once something was typed instead; until then a
  // file remembers it.
  std::error_code ignored;
  if (no_scan) {
    std::ofstream(folder() / kNoScan) << "measured by hand\n";
  } else {
    fs::remove(folder() / kNoScan, ignored);
  }
  soon_.start();
  emit scanChanged();
}

void VisitWork::save() {
  soon_.stop();
  const bool usable = !no_scan_ || !hasTypedMeasure();
  const bool changed = now_ != before_ || usable != facts_.visit.content.usable_scan;
  if (!open_ || saving_ || !changed || !mayEdit()) {
    return;
  }
  saving_ = true;
  sent_ = now_;
  const FormEdit edit{.visit_id = facts_.visit.id,
                      .base_revision = facts_.visit.revision,
                      .before = before_,
                      .now = now_,
                      .usable_scan = usable};
  session_.ask<FormSaved>(
      Session::Kind::Write,
      this,
      [edit](Store& store) { return saveForm(store, edit); },
      [this, id = edit.visit_id](const Expected<FormSaved>& saved) {
        if (open_ && facts_.visit.id == id) {
          finishSave(saved);
        }
      });
}

void VisitWork::finishSave(const Expected<FormSaved>& saved) {
  saving_ = false;
  if (!saved) {
    emit saveFailed(saved.error());
    return;
  }
  facts_.visit = saved->visit;
  const nlohmann::json& stored = facts_.visit.content.fields;
  for (const VisitField& field : visitFields()) {
    const std::string name(field.name);
    const auto there = stored.find(name);
    const auto here = now_.find(name);
    const auto sent = sent_.find(name);
    const bool touched =
        (here == now_.end()) != (sent == sent_.end()) || (here != now_.end() && *here != *sent);
    const bool differs =
        (here == now_.end()) != (there == stored.end()) || (here != now_.end() && *here != *there);
    if (touched || !differs) {
      continue;  // typed on while it was saved, or the same
    }
    if (there == stored.end()) {
      now_.erase(name);
    } else {
      now_[name] = *there;
    }
    emit fieldChanged(QString::fromStdString(name));
  }
  before_ = stored;
  if (saved->merged) {
    QStringList disputed;
    for (const std::string& name : saved->disputed) {
      disputed << QString::fromStdString(name);
    }
    emit merged(disputed);
  }
  if (now_ != before_) {
    soon_.start();
  }
}

void VisitWork::took(const Visit& visit) {
  facts_.visit = visit;
  before_ = visit.content.fields;
}

fs::path VisitWork::folder() const {
  const fs::path work = session_.folder() / "work";
  const fs::path own = work / facts_.visit.id;
  std::error_code ignored;
  fs::create_directories(own, ignored);
  for (const fs::path& each : {work, own}) {
    fs::permissions(each, fs::perms::owner_all, ignored);
  }
  return own;
}

void VisitWork::takeRecording(const fs::path& recording) {
  build_.clear();
  const fs::path own = folder();
  for (const char* name : {"scan", "scan.oni", "scan.oni.json", "model"}) {
    removeSoon(own / name);
  }
  std::error_code error;
  fs::rename(recording, own / "scan", error);
  if (error) {
    emit saveFailed({ErrorCode::FileUnwritable, own.string()});
    return;
  }
  has_scan_ = true;
  setNoScan(false);
  emit scanChanged();
  build_.start(own);
}

void VisitWork::useFile(const fs::path& scan) {
  setNoScan(false);
  build_.start(folder(), scan);
}

}  // namespace tarsus
