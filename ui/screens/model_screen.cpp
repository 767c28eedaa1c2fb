#include "ui/screens/model_screen.h"

#include "ui/parts/controls.h"
#include "ui/parts/words.h"
#include "ui/scene/model_loader.h"
#include "ui/scene/model_view.h"
#include "ui/scene/view_overlay.h"
#include "ui/screens/model_facts.h"
#include "ui/screens/model_panel.h"
#include "ui/screens/model_start.h"

#include <QAction>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace tarsus {

ModelScreen::ModelScreen(QWidget* parent) : Screen(parent), crumbs_{tr("Model file")} {
  loader_ = new ModelLoader(this);
  connect(loader_, &ModelLoader::loaded, this, &ModelScreen::showModel);
  connect(loader_, &ModelLoader::refused, this, &ModelScreen::showProblem);
  auto* start = new ModelStart;
  connect(start, &ModelStart::openRequested, this, &ModelScreen::chooseFile);
  pages_ = new QStackedWidget;
  pages_->addWidget(start);
  pages_->addWidget(makeModelPage());
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  problem_ = makeProblem();
  layout->addWidget(problem_);
  layout->addWidget(pages_, 1);
  makeKeys();
  setStatus(tr("Ctrl+O opens a model."));
}

ModelScreen::~ModelScreen() = default;

void ModelScreen::setStatus(const QString& text) {
  status_ = text;
  emit statusChanged();
}

QWidget* ModelScreen::makeProblem() {
  auto* air = new QWidget;  // around the note; hidden with it
  auto* margin = new QVBoxLayout(air);
  margin->setContentsMargins(24, 24, 24, 0);
  auto* note = new QFrame;
  note->setProperty("note", QStringLiteral("danger"));
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
  connect(another, &QPushButton::clicked, this, &ModelScreen::chooseFile);
  row->addWidget(another, 0, Qt::AlignTop);
  QPushButton* close = makeButton(tr("Close"));
  connect(close, &QPushButton::clicked, air, &QWidget::hide);
  row->addWidget(close, 0, Qt::AlignTop);
  air->hide();
  return air;
}

QWidget* ModelScreen::makeModelPage() {
  auto* page = new QWidget;
  page->setObjectName(QStringLiteral("page"));
  auto* row = new QHBoxLayout(page);
  row->setContentsMargins(24, 24, 24, 24);
  row->setSpacing(24);
  auto* picture = new QWidget;
  auto* grid = new QGridLayout(picture);
  grid->setContentsMargins(0, 0, 0, 0);
  view_ = new ModelView;
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
  scale_bar_ = new ScaleBar;
  auto* bottom = new QHBoxLayout;
  bottom->setContentsMargins(12, 12, 12, 12);
  bottom->addWidget(scale_bar_);
  grid->addLayout(bottom, 2, 2, Qt::AlignRight | Qt::AlignBottom);
  row->addWidget(picture, 1);
  panel_ = new ModelPanel;
  row->addWidget(panel_);
  connect(tools_, &ViewTools::texturedChosen, this, &ModelScreen::setTextured);
  connect(view_, &ModelView::rendered, scale_bar_, [this] {
    scale_bar_->setMmPerPixel(view_->mmPerPixel());
  });
  return page;
}

void ModelScreen::addKey(const QString& name, const QKeySequence& key, std::function<void()> act) {
  auto* action = new QAction(name, this);
  action->setShortcut(key);
  connect(action, &QAction::triggered, this, [this, act = std::move(act)] {
    if (model_) {
      act();
    }
  });
  addAction(action);
}

void ModelScreen::makeKeys() {
  addKey(tr("Front view"), Qt::Key_1, [this] { view_->look(StandardView::Front); });
  addKey(tr("Back view"), Qt::Key_2, [this] { view_->look(StandardView::Back); });
  addKey(tr("Left view"), Qt::Key_3, [this] { view_->look(StandardView::Left); });
  addKey(tr("Right view"), Qt::Key_4, [this] { view_->look(StandardView::Right); });
  addKey(tr("Fit"), Qt::Key_F, [this] { view_->fit(); });
  addKey(tr("Texture or relief"), Qt::Key_T, [this] { setTextured(!view_->textured()); });
}

void ModelScreen::open(const QString& path) {
  setStatus(tr("Opening %1").arg(QFileInfo(path).fileName()));
  loader_->load(path);
}

void ModelScreen::chooseFile() {
  const QString path = QFileDialog::getOpenFileName(
      this, tr("Open a model"), {}, tr("Models (*.ply);;All files (*)"));
  if (!path.isEmpty()) {
    open(path);
  }
}

QString ModelScreen::problem() const {
  return problem_->isHidden() ? QString() : problem_text_->text();
}

void ModelScreen::showModel(const QString& path, std::shared_ptr<const TexturedMesh> model) {
  model_ = std::move(model);
  problem_->hide();
  const QFileInfo file(path);
  crumbs_ =
      QStringList{tr("Model file"), file.dir().dirName() + QLatin1Char('/') + file.fileName()};
  emit crumbsChanged();
  panel_->showFacts(file.fileName(), factsOf(*model_), model_->sha256);
  pages_->setCurrentIndex(1);
  view_->showModel(model_);
  setTextured(true);
  setStatus(
      tr("Drag turns · Shift and drag slides · wheel zooms · 1 to 4 views · F fits · "
         "T texture or relief"));
  emit modelShown();
}

void ModelScreen::showProblem(const QString& path, const Error& error) {
  problem_title_->setText(tr("%1 was not opened").arg(QFileInfo(path).fileName()));
  problem_text_->setText(sentenceOf(error));
  problem_detail_->setText(tr("For the technician: %1").arg(QString::fromStdString(error.detail)));
  problem_detail_->setVisible(!error.detail.empty());
  problem_->show();
  setStatus(model_ ? tr("The model before is still shown.") : tr("Ctrl+O opens a model."));
  emit modelRefused();
}

void ModelScreen::setTextured(bool textured) {
  view_->setTextured(textured);
  tools_->setTextured(textured, !model_->colors.empty());
}

}  // namespace tarsus
