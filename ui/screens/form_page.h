#pragma once

#include "ui/screens/visit_page.h"

#include <string>
#include <vector>

class QCheckBox;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QScrollArea;
class QVBoxLayout;

namespace tarsus {

class BuildPanel;
class ChoiceRow;
class FormField;
struct FormSection;

/// The form, in sections, beside the model that is being built.
class FormPage : public VisitPage {
  Q_OBJECT

 public:
  explicit FormPage(VisitWork& work);
  void reset() override;
  void enter() override;
  void leave() override;
  void primary() override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Section {
    const FormSection* form = nullptr;
    QWidget* box = nullptr;
    QPushButton* button = nullptr;
  };

  [[nodiscard]] QWidget* makeNavigation();
  [[nodiscard]] QWidget* makeForm();
  [[nodiscard]] QWidget* makeRow(const std::vector<std::string_view>& names);
  void makeSigns(QVBoxLayout* column, const std::vector<std::string_view>& names);
  void fill();
  void take(const QString& name, const void* value);
  void answerSigns(bool none);
  void showDone();
  void showSigns();
  void goToSection(std::size_t index);
  void followScroll();
  void arrange();
  [[nodiscard]] bool isDone(const FormSection& section) const;
  [[nodiscard]] FormField* field(std::string_view name) const;

  QScrollArea* scroll_ = nullptr;
  ChoiceRow* tabs_ = nullptr;  ///< where there is room for one thing only
  QWidget* card_ = nullptr;
  bool tight_ = false;
  QWidget* navigation_ = nullptr;
  BuildPanel* build_ = nullptr;
  QLabel* done_ = nullptr;
  QCheckBox* no_signs_ = nullptr;
  std::vector<Section> sections_;
  std::vector<FormField*> fields_;
  std::size_t current_ = 0;
};

}  // namespace tarsus
