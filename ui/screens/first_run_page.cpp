#include "ui/screens/first_run_page.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"
#include "ui/parts/note.h"
#include "ui/parts/password_field.h"
#include "ui/parts/words.h"

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QVBoxLayout>

namespace tarsus {
namespace {

constexpr std::array kOffered{Role::Nurse, Role::Physician, Role::Administrator};

}  // namespace

FirstRunPage::FirstRunPage(Session& session)
    : GatePage(532,
               tr("Welcome. Set up this computer"),
               tr("You become the administrator. Everything stays on this computer.")),
      session_(session) {
  column()->addWidget(makeFields());
  demo_ = new QCheckBox(tr("Load the demo patient"));
  demo_->setObjectName(QStringLiteral("demo"));
  demo_->setChecked(true);
  Look::setType(demo_, TypeRole::Strong);
  column()->addSpacing(4);
  column()->addWidget(demo_);
  QLabel* what = makeLabel(tr("One foot, five visits, made by computer. You can delete it later."),
                           TypeRole::Small,
                           QStringLiteral("secondary"));
  what->setIndent(Look::px(32));
  column()->addWidget(what);
  problem_ = new Note(Note::Kind::Danger);
  column()->addWidget(problem_);
  column()->addSpacing(8);
  go_ = makeButton(tr("Create and start"), QStringLiteral("primary"));
  go_->setObjectName(QStringLiteral("create"));
  column()->addWidget(go_);
  connect(go_, &QPushButton::clicked, this, &FirstRunPage::primary);
  connect(again_, &QLineEdit::returnPressed, this, &FirstRunPage::primary);
}

QWidget* FirstRunPage::makeFields() {
  auto* fields = new QWidget;
  auto* grid = new QGridLayout(fields);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(16);
  grid->setVerticalSpacing(16);
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(1, 1);
  name_ = new QLineEdit;
  name_->setObjectName(QStringLiteral("name"));
  role_ = new QComboBox;
  for (const Role role : kOffered) {
    role_->addItem(roleWord(role));
  }
  clinic_ = new QLineEdit;
  clinic_->setObjectName(QStringLiteral("clinic"));
  password_ = new PasswordField;
  password_->setObjectName(QStringLiteral("new password"));
  again_ = new PasswordField;
  again_->setObjectName(QStringLiteral("password again"));
  name_frame_ = new FieldFrame(tr("Your name"), name_);
  role_frame_ = new FieldFrame(tr("Your role"), role_);
  password_frame_ = new FieldFrame(tr("Password"), password_, tr("At least 10 characters"));
  again_frame_ = new FieldFrame(tr("Password again"), again_);
  grid->addWidget(name_frame_, 0, 0, Qt::AlignTop);
  grid->addWidget(role_frame_, 0, 1, Qt::AlignTop);
  grid->addWidget(new FieldFrame(tr("Clinic name, printed on reports"), clinic_), 1, 0, 1, 2);
  grid->addWidget(password_frame_, 2, 0, Qt::AlignTop);
  grid->addWidget(again_frame_, 2, 1, Qt::AlignTop);
  for (QLineEdit* field :
       {name_, static_cast<QLineEdit*>(password_), static_cast<QLineEdit*>(again_)}) {
    connect(field, &QLineEdit::textEdited, this, [this] {
      for (FieldFrame* frame : {name_frame_, password_frame_, again_frame_}) {
        frame->clearError();
      }
    });
  }
  // Said as soon as the second is left, not only at the end.
  connect(again_, &QLineEdit::editingFinished, this, [this] {
    if (!again_->text().isEmpty() && again_->text() != password_->text()) {
      again_frame_->setError(tr("The two passwords differ."));
    }
  });
  return fields;
}

void FirstRunPage::entered() { name_->setFocus(); }

bool FirstRunPage::check() {
  constexpr int kShortest = 10;
  QWidget* first = nullptr;
  const auto refuse = [&](FieldFrame* frame, const QString& error) {
    frame->setError(error);
    first = first == nullptr ? frame->field() : first;
  };
  if (name_->text().trimmed().isEmpty()) {
    refuse(name_frame_, tr("Type your name."));
  }
  if (password_->text().size() < kShortest) {
    refuse(password_frame_, tr("At least 10 characters, please."));
  }
  if (again_->text() != password_->text()) {
    refuse(again_frame_, tr("The two passwords differ."));
  }
  if (first != nullptr) {
    first->setFocus();
  }
  return first == nullptr;
}

void FirstRunPage::primary() {
  if (busy_ || !check()) {
    return;
  }
  busy_ = true;
  problem_->setText({});
  setBusy(go_, true, tr("Setting up"));
  session_.firstRun({.name = name_->text().trimmed().toStdString(),
                     .role = kOffered.at(static_cast<std::size_t>(role_->currentIndex())),
                     .clinic = clinic_->text().trimmed().toStdString(),
                     .password = password_->text().toStdString(),
                     .demo = demo_->isChecked()},
                    [this](const Expected<std::string>& code) {
                      busy_ = false;
                      setBusy(go_, false, tr("Create and start"));
                      if (!code) {
                        problem_->setText(tr("This computer was not set up."),
                                          sentenceOf(code.error()));
                        return;
                      }
                      password_->reset();
                      again_->reset();
                      emit created(QString::fromStdString(*code));
                    });
}

}  // namespace tarsus
