#include "ui/main_window.h"

#include "ui/model_facts.h"
#include "ui/model_loader.h"
#include "ui/model_panel.h"
#include "ui/model_view.h"
#include "ui/start_page.h"
#include "ui/view_overlay.h"
#include "ui/widgets.h"

#include <QAction>
#include <QCoreApplication>
#include <QDir>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QMimeData>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace tarsus {
namespace {

QString firstFile(const QMimeData* data) {
  for (const QUrl& url : data->urls()) {
    if (url.isLocalFile()) {
      return url.toLocalFile();
    }
  }
  return {};
}

QString translated(std::string_view english) {
  const std::string text(english);
  return QCoreApplication::translate("Error", text.c_str());
}

}  // namespace

MainWindow::MainWindow(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
  setObjectName(QStringLiteral("window"));
  setAttribute(Qt::WA_StyledBackground);
  setWindowTitle(tr("Tarsus"));
  setMinimumSize(900, 600);
  resize(1440, 900);
  setAcceptDrops(true);
  setStyleSheet(theme_.styleSheet());
  loader_ = new ModelLoader(this);
  connect(loader_, &ModelLoader::loaded, this, &MainWindow::showModel);
  connect(loader_, &ModelLoader::refused, this, &MainWindow::showProblem);

  auto* start = new StartPage;
  connect(start, &StartPage::openRequested, this, &MainWindow::chooseFile);
  pages_ = new QStackedWidget;
  pages_->addWidget(start);
  pages_->addWidget(makeModelPage());
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(makeHeader());
  problem_ = makeProblem();
  layout->addWidget(problem_);
  layout->addWidget(pages_, 1);
  layout->addWidget(makeStatus());
  makeActions();
}

MainWindow::~MainWindow() = default;

QWidget* MainWindow::makeHeader() {
  auto* header = new QWidget;
  header->setObjectName(QStringLiteral("header"));
  header->setAttribute(Qt::WA_StyledBackground);
  header->setFixedHeight(56);
  auto* row = new QHBoxLayout(header);
  row->setContentsMargins(20, 0, 24, 0);
  row->setSpacing(8);
  row->addWidget(new Mark(theme_));
  QLabel* name = makeLabel(tr("Tarsus"), TypeRole::Heading);
  name->setWordWrap(false);
  row->addWidget(name);
  row->addSpacing(16);
  crumb_ = makeLabel({}, TypeRole::Base, QStringLiteral("secondary"));
  crumb_->setWordWrap(false);
  row->addWidget(crumb_, 1);
  open_ = makeButton(tr("Open another model"));
  open_->setToolTip(tr("Ctrl+O"));
  open_->hide();
  connect(open_, &QPushButton::clicked, this, &MainWindow::chooseFile);
  row->addWidget(open_);
  return header;
}

QWidget* MainWindow::makeStatus() {
  auto* status = new QWidget;
  status->setObjectName(QStringLiteral("status"));
  status->setAttribute(Qt::WA_StyledBackground);
  status->setFixedHeight(28);
  auto* row = new QHBoxLayout(status);
  row->setContentsMargins(20, 0, 20, 0);
  state_ = makeLabel(tr("Ctrl+O opens a model."), TypeRole::Small, QStringLiteral("secondary"));
  state_->setWordWrap(false);
  row->addWidget(state_, 1);
  QLabel* use = makeLabel(
      tr("Research software. Not a medical device."), TypeRole::Small, QStringLiteral("secondary"));
  use->setObjectName(QStringLiteral("research use"));
  use->setWordWrap(false);
  row->addWidget(use);
  return status;
}

QWidget* MainWindow::makeProblem() {
  auto* air = new QWidget;  // around the note; hidden with it
  auto* margin = new QVBoxLayout(air);
  margin->setContentsMargins(24, 24, 24, 0);
  auto* note = new QFrame;
  note->setProperty("tone", QStringLiteral("danger"));
  margin->addWidget(note);
  auto* row = new QHBoxLayout(note);
  row->setContentsMargins(16, 12, 12, 12);
  row->setSpacing(12);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(4);
  problem_title_ = makeLabel({}, TypeRole::Label);
  problem_text_ = makeLabel({}, TypeRole::Base);
  problem_detail_ = makeLabel({}, TypeRole::Small);
  for (QLabel* label : {problem_title_, problem_text_, problem_detail_}) {
    texts->addWidget(label);
  }
  row->addLayout(texts, 1);
  QPushButton* another = makeButton(tr("Choose another file"));
  connect(another, &QPushButton::clicked, this, &MainWindow::chooseFile);
  row->addWidget(another, 0, Qt::AlignTop);
  QPushButton* close = makeButton(tr("Close"));
  connect(close, &QPushButton::clicked, air, &QWidget::hide);
  row->addWidget(close, 0, Qt::AlignTop);
  air->hide();
  return air;
}

QWidget* MainWindow::makeModelPage() {
  auto* page = new QWidget;
  page->setObjectName(QStringLiteral("page"));
  auto* row = new QHBoxLayout(page);
  row->setContentsMargins(24, 24, 24, 24);
  row->setSpacing(24);
  auto* picture = new QWidget;
  auto* grid = new QGridLayout(picture);
  grid->setContentsMargins(0, 0, 0, 0);
  view_ = new ModelView(theme_);
  grid->addWidget(view_, 0, 0, 3, 3);
  tools_ = new ViewTools;
  auto* top = new QHBoxLayout;
  top->setContentsMargins(12, 12, 12, 12);
  top->addWidget(tools_);
  grid->addLayout(top, 0, 0, Qt::AlignLeft | Qt::AlignTop);
  auto* views = new ViewButtons;
  auto* corner = new QHBoxLayout;
  corner->setContentsMargins(12, 12, 12, 12);
  corner->addWidget(views);
  grid->addLayout(corner, 2, 0, Qt::AlignLeft | Qt::AlignBottom);
  connect(views, &ViewButtons::viewChosen, view_, &ModelView::look);
  connect(views, &ViewButtons::fitChosen, view_, &ModelView::fit);
  scale_bar_ = new ScaleBar(theme_);
  auto* bottom = new QHBoxLayout;
  bottom->setContentsMargins(12, 12, 12, 12);
  bottom->addWidget(scale_bar_);
  grid->addLayout(bottom, 2, 2, Qt::AlignRight | Qt::AlignBottom);
  row->addWidget(picture, 1);
  panel_ = new ModelPanel;
  row->addWidget(panel_);
  connect(tools_, &ViewTools::texturedChosen, this, &MainWindow::setTextured);
  connect(view_, &ModelView::rendered, scale_bar_, [this] {
    scale_bar_->setMmPerPixel(view_->mmPerPixel());
  });
  return page;
}

void MainWindow::addKey(const QString& name, const QKeySequence& key, std::function<void()> act) {
  auto* action = new QAction(name, this);
  action->setShortcut(key);
  connect(action, &QAction::triggered, this, [this, act = std::move(act)] {
    if (model_) {
      act();
    }
  });
  addAction(action);
}

void MainWindow::makeActions() {
  auto* open = new QAction(tr("Open a model"), this);
  open->setShortcut(QKeySequence::Open);
  connect(open, &QAction::triggered, this, &MainWindow::chooseFile);
  addAction(open);
  addKey(tr("Front view"), Qt::Key_1, [this] { view_->look(StandardView::Front); });
  addKey(tr("Back view"), Qt::Key_2, [this] { view_->look(StandardView::Back); });
  addKey(tr("Left view"), Qt::Key_3, [this] { view_->look(StandardView::Left); });
  addKey(tr("Right view"), Qt::Key_4, [this] { view_->look(StandardView::Right); });
  addKey(tr("Fit"), Qt::Key_F, [this] { view_->fit(); });
  addKey(tr("Texture or relief"), Qt::Key_T, [this] { setTextured(!view_->textured()); });
}

void MainWindow::open(const QString& path) {
  state_->setText(tr("Opening %1").arg(QFileInfo(path).fileName()));
  loader_->load(path);
}

void MainWindow::chooseFile() {
  const QString path = QFileDialog::getOpenFileName(
      this, tr("Open a model"), {}, tr("Models (*.ply);;All files (*)"));
  if (!path.isEmpty()) {
    open(path);
  }
}

QString MainWindow::problem() const {
  return problem_->isHidden() ? QString() : problem_text_->text();
}

void MainWindow::showModel(const QString& path, std::shared_ptr<const TexturedMesh> model) {
  model_ = std::move(model);
  problem_->hide();
  const QFileInfo file(path);
  crumb_->setText(file.dir().dirName() + QStringLiteral("  ›  ") + file.fileName());
  crumb_->setToolTip(file.absoluteFilePath());
  setWindowTitle(tr("%1 - Tarsus").arg(file.fileName()));
  panel_->showFacts(file.fileName(), factsOf(*model_), model_->sha256);
  pages_->setCurrentIndex(1);
  open_->show();
  view_->showModel(model_);
  setTextured(true);
  state_->setText(
      tr("Drag turns · Shift and drag slides · wheel zooms · 1 to 4 views · F fits · "
         "T texture or relief"));
  emit modelShown();
}

void MainWindow::showProblem(const QString& path, const Error& error) {
  problem_title_->setText(tr("%1 was not opened").arg(QFileInfo(path).fileName()));
  problem_text_->setText(translated(codeSentence(error.code)));
  problem_detail_->setText(tr("For the technician: %1").arg(QString::fromStdString(error.detail)));
  problem_detail_->setVisible(!error.detail.empty());
  problem_->show();
  state_->setText(model_ ? tr("The model before is still shown.") : tr("Ctrl+O opens a model."));
  emit modelRefused();
}

void MainWindow::setTextured(bool textured) {
  view_->setTextured(textured);
  tools_->setTextured(textured, !model_->colors.empty());
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (!firstFile(event->mimeData()).isEmpty()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QString path = firstFile(event->mimeData());
  if (!path.isEmpty()) {
    event->acceptProposedAction();
    open(path);
  }
}

}  // namespace tarsus
