#include "ui/look/theme.h"

#include <QRegularExpression>

#include <cmath>
#include <vector>

namespace tarsus {
namespace {

// "@name" is a colour, "16sp" a size that grows with the text, "@icon(name,colour)" a file.
const QString& sheet() {
  static const QString text = QStringLiteral(R"(
QWidget#window, QWidget#page { background: @background; }
QWidget#header, QWidget#status { background: @surface; }
QWidget#header { border-bottom: 1px solid @line; }
QWidget#status { border-top: 1px solid @line; }
QWidget#brand { background: @brand; }
QWidget#brand QLabel { color: @on_brand; }
QFrame[role="card"] { background: @surface; border: @note_edge solid @line; border-radius: 6px; }
QFrame[role="well"] { background: @sunk; border: @note_edge solid @line; border-radius: 6px; }
QFrame[role="line"] { background: @line; border: none; }
QFrame[note="danger"] { background: @danger_weak; border: @note_edge solid @danger; border-radius: 6px; }
QFrame[note="danger"] QLabel { color: @danger_text; }
QFrame[note="warning"] { background: @warning_weak; border: @note_edge solid @warning; border-radius: 6px; }
QFrame[note="warning"] QLabel { color: @text; }
QLabel { color: @text; background: transparent; }
QLabel[tone="secondary"] { color: @text2; }
QLabel[tone="danger"] { color: @danger_text; }
QLabel[tone="accent"] { color: @accent_text; }
QLabel[chip="good"] { background: @accent_weak; color: @accent_text; border: @note_edge solid @line; border-radius: 6px; padding: 4sp 10sp; }
QLabel[chip="bad"] { background: @danger_weak; color: @danger_text; border: @note_edge solid @line; border-radius: 6px; padding: 4sp 10sp; }
QLabel[chip="unknown"] { background: @warning_weak; color: @warning_text; border: @note_edge solid @line; border-radius: 6px; padding: 4sp 10sp; }
QPushButton { background: @surface; color: @text; border: @edge_px solid @edge; border-radius: 6px; padding: 0 16sp; min-height: 38sp; icon-size: 20sp; }
QPushButton[target="large"] { min-height: 46sp; }
QPushButton:hover { background: @sunk; }
QPushButton:disabled { color: @text2; background: @sunk; border-color: @line; }
QPushButton[role="primary"] { background: @accent; color: @on_accent; border: @edge_px solid @accent; min-height: 46sp; }
QPushButton[role="primary"]:hover { background: @accent_text; }
QPushButton[role="primary"]:disabled { background: @accent_off; color: @on_accent; border-color: @accent_off; }
QPushButton[role="quiet"] { background: transparent; color: @accent_text; border: @edge_px solid transparent; padding: 0 8sp; }
QPushButton[role="quiet"]:hover { background: @accent_weak; }
QPushButton[role="danger"] { background: @surface; color: @danger_text; border: @edge_px solid @danger; }
QPushButton[role="danger"]:hover { background: @danger_weak; }
QPushButton[role="crumb"] { background: transparent; color: @text2; border: none; padding: 0 6sp; }
QPushButton[role="crumb"]:hover { color: @accent_text; }
QPushButton[role="crumb"]:disabled { background: transparent; color: @text; }
QPushButton[role="earlier"] { background: transparent; color: @text2; border: none; padding: 0 2sp; min-height: 18sp; }
QPushButton[role="earlier"]:hover { color: @accent_text; }
QPushButton[role="earlier"]:disabled { background: transparent; color: @text2; }
QPushButton[role="section"] { background: transparent; color: @text; border: none; text-align: left; padding: 0 12sp; min-height: 46sp; }
QPushButton[role="section"]:hover { background: @sunk; }
QPushButton[role="section"]:checked { background: @accent_weak; color: @accent_text; }
QPushButton[role="stop"] { background: @accent; color: @on_accent; border: @edge_px solid @accent; min-height: 94sp; }
QPushButton[role="stop"]:hover { background: @accent_text; }
QPushButton[role="stop"]:disabled { background: @accent_off; color: @on_accent; border-color: @accent_off; }
QCheckBox[role="tile"] { background: @surface; border: @edge_px solid @edge; border-radius: 6px; padding: 0 14sp; min-height: 46sp; }
QCheckBox[role="tile"]:hover { background: @sunk; }
QCheckBox[role="tile"]:checked { background: @accent_weak; }
QPlainTextEdit { background: @surface; color: @text; border: @edge_px solid @edge; border-radius: 6px; padding: 8sp; selection-background-color: @accent; selection-color: @on_accent; }
QFrame[role="view"] { background: @view; border: @note_edge solid @line; border-radius: 6px; }
QFrame[role="tag"] { background: @surface; border: @note_edge solid @line; border-radius: 6px; }
QFrame[role="dialog"] { background: @surface; border: 1px solid @line; border-radius: 6px; }
QFrame[state="good"] { background: @accent_weak; border: @note_edge solid @accent; border-radius: 6px; }
QFrame[state="weak"] { background: @warning_weak; border: @note_edge solid @warning; border-radius: 6px; }
QFrame[state="lost"] { background: @danger_weak; border: @note_edge solid @danger; border-radius: 6px; }
QFrame[state="plain"] { background: @surface; border: @note_edge solid @line; border-radius: 6px; }
QToolButton { background: @surface; color: @text; border: @edge_px solid @edge; border-radius: 6px; padding: 0 12sp; min-height: 38sp; icon-size: 20sp; }
QToolButton:disabled { color: @text2; background: @sunk; border: 1px solid @line; }
QToolButton:hover { background: @sunk; }
QToolButton:checked { background: @accent_weak; color: @accent_text; border: @edge_px solid @accent; }
QToolButton[target="large"] { min-height: 46sp; }
QToolButton[role="icon"] { background: transparent; border: none; padding: 0; min-width: 40sp; min-height: 40sp; }
QToolButton[role="icon"]:hover { background: @sunk; }
QToolButton[role="person"] { background: @accent_weak; color: @accent_text; border: @note_edge solid @accent; border-radius: 17sp; padding: 0; min-width: 34sp; max-width: 34sp; min-height: 34sp; max-height: 34sp; }
QToolButton::menu-indicator { image: none; }
QToolButton[segment="first"] { border-top-right-radius: 0; border-bottom-right-radius: 0; }
QToolButton[segment="middle"] { border-radius: 0; border-left: none; }
QToolButton[segment="last"] { border-top-left-radius: 0; border-bottom-left-radius: 0; border-left: none; }
QToolButton[segment]:checked { border-color: @edge; }
QLineEdit, QComboBox, QDateEdit, QDoubleSpinBox { background: @surface; color: @text; border: @edge_px solid @edge; border-radius: 6px; padding: 0 12sp; min-height: 46sp; selection-background-color: @accent; selection-color: @on_accent; }
QLineEdit[target="desk"], QComboBox[target="desk"] { min-height: 38sp; }
QLineEdit[state="error"], QComboBox[state="error"] { border: 2px solid @danger; }
QLineEdit:disabled, QComboBox:disabled { background: @sunk; color: @text2; }
QLineEdit QToolButton { background: transparent; border: none; padding: 0; min-height: 0; }
QComboBox::drop-down { border: none; width: 36sp; }
QComboBox::down-arrow { image: url(@icon(chevron-down,text)); width: 20sp; height: 20sp; }
QComboBox QAbstractItemView { background: @surface; color: @text; border: 1px solid @edge; outline: none; padding: 4px; selection-background-color: @accent_weak; selection-color: @accent_text; }
QComboBox QAbstractItemView::item { min-height: 40sp; padding: 0 8sp; }
QCheckBox, QRadioButton { color: @text; spacing: 12sp; min-height: 24sp; background: transparent; }
QCheckBox::indicator { width: 18sp; height: 18sp; border: @edge_px solid @edge; border-radius: 4px; background: @surface; }
QCheckBox::indicator:checked { background: @accent; border-color: @accent; image: url(@icon(tick-box,on_accent)); }
QRadioButton::indicator { width: 18sp; height: 18sp; border: @edge_px solid @edge; border-radius: 10sp; background: @surface; }
QRadioButton::indicator:checked { background: @accent; border-color: @accent; image: url(@icon(radio-dot,on_accent)); }
QListView { background: transparent; border: none; outline: none; }
QScrollArea, QScrollArea > QWidget > QWidget { background: transparent; border: none; }
QScrollBar:vertical { background: transparent; width: 12px; margin: 0; }
QScrollBar:horizontal { background: transparent; height: 12px; margin: 0; }
QScrollBar::handle { background: @edge; border-radius: 4px; margin: 2px; min-height: 32px; min-width: 32px; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
QMenu { background: @surface; color: @text; border: 1px solid @edge; padding: 4px; }
QMenu::item { padding: 10sp 16sp; border-radius: 4px; }
QMenu::item:selected { background: @accent_weak; color: @accent_text; }
QProgressBar { background: @sunk; border: @note_edge solid @line; border-radius: 4px; max-height: 8px; }
QProgressBar::chunk { background: @accent; border-radius: 4px; }
QToolTip { background: @text; color: @surface; border: none; padding: 4px; }
)");
  return text;
}

QColor halfway(const QColor& a, const QColor& b) {
  return {(a.red() + b.red()) / 2, (a.green() + b.green()) / 2, (a.blue() + b.blue()) / 2};
}

using Tokens = std::vector<std::pair<QString, QColor>>;

Tokens tokensOf(const Theme& t) {
  // Longer names first, so that none is the beginning of one still to come.
  const bool pale = contrast(t.accent, Qt::white) < 4.5;
  return {{QStringLiteral("background"), t.background},
          {QStringLiteral("surface"), t.surface},
          {QStringLiteral("sunk"), t.sunk},
          {QStringLiteral("accent_text"), t.accent_text},
          {QStringLiteral("accent_weak"), t.accent_weak},
          {QStringLiteral("accent_off"), halfway(t.accent, t.surface)},
          {QStringLiteral("on_accent"), t.on_accent},
          {QStringLiteral("on_brand"), pale ? t.text : t.on_accent},
          {QStringLiteral("accent"), t.accent},
          {QStringLiteral("brand"), pale ? t.accent_weak : t.accent},
          {QStringLiteral("danger_text"), t.danger_text},
          {QStringLiteral("danger_weak"), t.danger_weak},
          {QStringLiteral("danger"), t.danger},
          {QStringLiteral("warning_text"), t.warning_text},
          {QStringLiteral("warning_weak"), t.warning_weak},
          {QStringLiteral("warning"), t.warning},
          {QStringLiteral("text2"), t.text_secondary},
          {QStringLiteral("text"), t.text},
          {QStringLiteral("line"), t.line},
          {QStringLiteral("edge"), t.control_edge},
          {QStringLiteral("view"), t.view}};
}

void placeIcons(QString& filled,
                const Tokens& tokens,
                QString (*icon_file)(const QString&, const QColor&)) {
  static const QRegularExpression icon(QStringLiteral("@icon\\(([a-z-]+),([a-z_]+)\\)"));
  for (auto match = icon.match(filled); match.hasMatch(); match = icon.match(filled)) {
    QString file;
    for (const auto& [name, color] : tokens) {
      if (name == match.captured(2)) {
        file = icon_file(match.captured(1), color);
      }
    }
    filled.replace(match.capturedStart(), match.capturedLength(), file);
  }
}

void scaleSizes(QString& filled, int percent) {
  static const QRegularExpression size(QStringLiteral("\\b(\\d+)sp\\b"));
  for (auto match = size.match(filled); match.hasMatch(); match = size.match(filled)) {
    const int px = static_cast<int>(std::lround(match.captured(1).toInt() * percent / 100.0));
    filled.replace(
        match.capturedStart(), match.capturedLength(), QString::number(px) + QStringLiteral("px"));
  }
}

}  // namespace

QString styleSheet(const Theme& theme,
                   int percent,
                   QString (*icon_file)(const QString& name, const QColor& color)) {
  QString filled = sheet();
  const Tokens tokens = tokensOf(theme);
  placeIcons(filled, tokens, icon_file);
  const auto px = [](int width) { return QString::number(width) + QStringLiteral("px"); };
  filled.replace(QStringLiteral("@edge_px"), px(theme.edge_px));
  filled.replace(QStringLiteral("@note_edge"), px(theme.note_edge_px));
  for (const auto& [name, color] : tokens) {
    filled.replace(QLatin1Char('@') + name, color.name());
  }
  scaleSizes(filled, percent);
  return filled;
}

}  // namespace tarsus
