#pragma once

#include "ui/look/look.h"

#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

namespace tarsus {

/// A word-wrapped label in a role of the theme; `tone` is "secondary", "accent", "danger" or empty.
[[nodiscard]] QLabel* makeLabel(const QString& text,
                                TypeRole role,
                                const QString& tone = {},
                                QWidget* parent = nullptr);
/// The same on one line.
[[nodiscard]] QLabel* makeLine(const QString& text, TypeRole role, const QString& tone = {});

/// @param role  "primary", "quiet", "danger" or empty
[[nodiscard]] QPushButton* makeButton(const QString& text,
                                      const QString& role = {},
                                      QWidget* parent = nullptr);
[[nodiscard]] QPushButton* makeButton(const QString& text, const QString& role, const char* icon);

/// An icon alone; its name is tooltip and accessible name.
[[nodiscard]] QToolButton* makeIconButton(const QString& icon, const QString& name);

/// A frame that the style sheet paints: "card", "well" or "line".
[[nodiscard]] QFrame* makeFrame(const QString& role, QWidget* parent = nullptr);

/// Sets a property that the style sheet asks for, and has it look again.
void setStyleProperty(QWidget* widget, const char* name, const QString& value);

/// "SL" of "Sofia Lindqvist"; titles are left out.
[[nodiscard]] QString initialsOf(const QString& name);

}  // namespace tarsus
