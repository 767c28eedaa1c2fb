#include "ui/work/scan_build.h"

#include "reconstruction/capture/openni/oni_file.h"
#include "reconstruction/pipeline/model_folder.h"
#include "reconstruction/pipeline/reconstruct.h"
#include "reconstruction/scene/ply.h"

#include <QCoreApplication>
#include <QThreadPool>
#include <QTimer>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <fstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What the reconstruction reports, the stage it belongs to, and the share of the time until its
/// end; by the stages of a scan of 600 frames.
struct Phase {
  const char* name;
  int stage;
  double begin;
  double end;
};
constexpr std::array kPhases{Phase{"bring", 0, 0.00, 0.02},
                             Phase{"tracking", 1, 0.02, 0.34},
                             Phase{"refine poses", 1, 0.34, 0.40},
                             Phase{"fusion", 2, 0.40, 0.52},
                             Phase{"surface", 2, 0.52, 0.68},
                             Phase{"keyframes", 3, 0.68, 0.74},
                             Phase{"texture", 3, 0.74, 0.95},
                             Phase{"align colours", 3, 0.76, 0.94},
                             Phase{"quality", 4, 0.95, 1.00}};

Expected<void> copied(const std::error_code& error, const fs::path& to) {
  if (!error) {
    return {};
  }
  return error == std::errc::no_space_on_device ? fail(ErrorCode::DiskFull, to.string())
                                                : fail(ErrorCode::FileUnwritable, to.string());
}

Expected<void> copyFolder(const fs::path& from, const fs::path& to, const Job& job) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator each(from, error), end; !error && each != end;
       each.increment(error)) {
    if (each->is_regular_file()) {
      files.push_back(each->path());
    }
  }
  if (error) {
    return fail(ErrorCode::FileUnreadable, from.string());
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    const fs::path target = to / files[i].lexically_relative(from);
    fs::create_directories(target.parent_path(), error);
    fs::copy_file(files[i], target, fs::copy_options::overwrite_existing, error);
    if (auto whole = copied(error, target); !whole) {
      return whole;
    }
    job.report("bring", static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  return {};
}

ScanQuality qualityOf(const Reconstruction& r) {
  return {.frames_total = r.frames_total,
          .frames_used = r.frames_tracked,
          .frames_contradicting = r.frames_contradicting,
          .misfit_mm = r.tracking_rmse_mm,
          .unseen_share = r.unseen_fraction,
          .reasons = r.refusal_reasons,
          .warnings = r.warnings};
}

Warnings warningsIn(const json& record, const char* key) {
  Warnings list;
  for (const json& each : record.value(key, json::array())) {
    list.push_back({each.value("code", std::string()), each.value("text", std::string())});
  }
  return list;
}

/// A model that was built before the program was closed; nothing where there is none to be read.
std::optional<BuiltModel> readBuilt(const fs::path& folder) {
  std::ifstream file(folder / "reconstruction.json");
  const json record = json::parse(file, nullptr, false);
  if (!record.is_object()) {
    return std::nullopt;
  }
  auto model = readPly(folder / "model.ply");
  if (!model) {
    return std::nullopt;
  }
  ScanQuality quality{.frames_total = record.value("frames_total", 0),
                      .frames_used = record.value("frames_tracked", 0),
                      .frames_contradicting = record.value("frames_contradicting", 0),
                      .misfit_mm = std::nullopt,
                      .unseen_share = record.value("unseen_fraction", 0.0),
                      .reasons = warningsIn(record, "refusal_reasons"),
                      .warnings = warningsIn(record, "warnings")};
  if (const auto misfit = record.find("tracking_rmse_mm");
      misfit != record.end() && misfit->is_number()) {
    quality.misfit_mm = misfit->get<double>();
  }
  return BuiltModel{std::make_shared<const TexturedMesh>(std::move(*model)), std::move(quality)};
}

Expected<BuiltModel> build(const fs::path& work, const std::string& version, const Job& job) {
  const fs::path scan = scanIn(work);
  const fs::path folder = work / "model";
  if (auto before = readBuilt(folder)) {
    return std::move(*before);
  }
  const ScanOptions options;
  auto made = reconstructScan(
      [&](const FrameContent& content) { return openScan(scan, {}, content); }, options, job);
  if (!made) {
    return tl::unexpected(made.error());
  }
  job.report("quality", 0.0);
  if (auto written = writeModelFolder(folder, *made, options, version); !written) {
    return tl::unexpected(written.error());
  }
  const ScanQuality quality = qualityOf(*made);
  return BuiltModel{std::make_shared<const TexturedMesh>(std::move(made->model)), quality};
}

}  // namespace

fs::path scanIn(const fs::path& work) {
  std::error_code ignored;
  for (const char* name : {"scan", "scan.oni"}) {
    if (fs::exists(work / name, ignored)) {
      return work / name;
    }
  }
  return {};
}

void removeSoon(const fs::path& path) {
  static std::atomic<int> count = 0;
  const fs::path aside = path.string() + ".old" + std::to_string(++count);
  std::error_code ignored;
  fs::remove_all(aside, ignored);  // of a day before, rarely there
  fs::rename(path, aside, ignored);
  QThreadPool::globalInstance()->start([aside] {
    std::error_code none;
    fs::remove_all(aside, none);
  });
}

Expected<void> bringScan(const fs::path& from, const fs::path& work, const Job& job) {
  if (auto usable = openScan(from); !usable) {
    return tl::unexpected(usable.error());
  }
  std::error_code ignored;
  const fs::path part = work / "coming";
  fs::remove_all(part, ignored);
  fs::create_directories(part, ignored);
  const bool is_folder = fs::is_directory(from, ignored);
  if (is_folder) {
    if (auto whole = copyFolder(from, part, job); !whole) {
      fs::remove_all(part, ignored);
      return whole;
    }
  } else {
    for (const char* ending : {"", ".json"}) {
      const fs::path source = from.string() + ending;
      std::error_code error;
      if (fs::exists(source, ignored)) {
        fs::copy_file(source, part / (std::string("scan.oni") + ending), error);
      }
      if (auto whole = copied(error, part); !whole) {
        fs::remove_all(part, ignored);
        return whole;
      }
    }
  }
  for (const char* old : {"scan", "scan.oni", "scan.oni.json", "model"}) {
    fs::remove_all(work / old, ignored);
  }
  std::error_code error;
  if (is_folder) {
    fs::rename(part, work / "scan", error);
    return copied(error, work);
  }
  for (const auto& file : fs::directory_iterator(part, ignored)) {
    fs::rename(file.path(), work / file.path().filename(), error);
  }
  fs::remove_all(part, ignored);
  return copied(error, work);
}

ScanBuild::ScanBuild(QObject* parent) : QObject(parent) {
  connect(&job_, &BackgroundJob::progressed, this, &ScanBuild::progress);
}

void ScanBuild::start(const fs::path& work, const fs::path& bring) {
  job_.cancel();
  work_ = work;
  bring_ = bring;
  built_ = {};
  fraction_ = 0.0;
  stage_ = 0;
  started_s_ = {};
  clock_.start();
  enter(State::Running);
  begin();
}

void ScanBuild::begin() {
  if (job_.windingDown()) {  // what was stopped looks for the stop now and then
    QTimer::singleShot(50, this, [this] {
      if (state_ == State::Running && !job_.running()) {
        begin();
      }
    });
    return;
  }
  const std::string version = QCoreApplication::applicationVersion().toStdString();
  job_.start<BuiltModel>(
      [work = work_, bring = bring_, version](const Job& job) -> Expected<BuiltModel> {
        if (!bring.empty()) {
          if (auto whole = bringScan(bring, work, job); !whole) {
            return tl::unexpected(whole.error());
          }
          job.report("bring", 2.0);
        }
        return build(work, version, job);
      },
      [this](Expected<BuiltModel> result) {
        ended_s_ = static_cast<double>(clock_.elapsed()) / 1000.0;
        if (!result) {
          problem_ = result.error();
          enter(State::Failed);
          return;
        }
        built_ = std::move(*result);
        fraction_ = 1.0;
        enter(State::Ready);
      });
}

void ScanBuild::cancel() {
  if (state_ == State::Running) {
    job_.cancel();
    enter(State::Cancelled);
  }
}

void ScanBuild::clear() {
  job_.cancel();
  built_ = {};
  enter(State::None);
}

void ScanBuild::enter(State state) {
  state_ = state;
  emit changed();
}

void ScanBuild::progress(const QString& name, double fraction) {
  if (name == QLatin1String("bring") && fraction > 1.0) {
    emit scanBrought();
    fraction = 1.0;
  }
  for (const Phase& phase : kPhases) {
    if (name == QLatin1String(phase.name)) {
      while (stage_ < phase.stage) {
        started_s_.at(static_cast<std::size_t>(++stage_)) =
            static_cast<double>(clock_.elapsed()) / 1000.0;
      }
      fraction_ = std::max(fraction_, phase.begin + (phase.end - phase.begin) * fraction);
    }
  }
  emit changed();
}

std::array<ScanBuild::Stage, ScanBuild::kStages> ScanBuild::stages() const {
  std::array<Stage, kStages> stages{};
  const double now =
      state_ == State::Running ? static_cast<double>(clock_.elapsed()) / 1000.0 : ended_s_;
  for (int i = 0; i < kStages; ++i) {
    Stage& stage = stages.at(static_cast<std::size_t>(i));
    stage.done = state_ == State::Ready || (state_ == State::Running && i < stage_);
    stage.running = state_ == State::Running && i == stage_;
    const double end =
        i < stage_ && i + 1 < kStages ? started_s_.at(static_cast<std::size_t>(i + 1)) : now;
    stage.seconds = i <= stage_ ? end - started_s_.at(static_cast<std::size_t>(i)) : 0.0;
  }
  return stages;
}

std::optional<double> ScanBuild::secondsLeft() const {
  constexpr double kEnough = 0.08;
  if (state_ != State::Running || fraction_ < kEnough) {
    return std::nullopt;
  }
  return static_cast<double>(clock_.elapsed()) / 1000.0 * (1.0 - fraction_) / fraction_;
}

}  // namespace tarsus
