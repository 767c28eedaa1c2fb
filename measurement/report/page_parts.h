#pragma once

#include "measurement/report/page_canvas.h"

#include <initializer_list>
#include <string>

namespace tarsus {

/// "4   Measurements": number in teal. @return the height used [mm]
double sectionHead(PageCanvas& canvas, const QPointF& top_left_mm, int number, const QString& name);

/// Title line of page 1 or the running line of the others, with the badge at its right.
/// @return where the content begins [mm]
double pageHead(PageCanvas& canvas, const ReportContent& content);

/// Research-use line, hash, version, time and "page n/N".
void pageFoot(PageCanvas& canvas, const ReportContent& content, int pages);

/// 5 mm black and 5 mm white with "1 cm", true to the picture's scale, at its lower left.
void scaleBar(PageCanvas& canvas, const QRectF& picture_mm, double print_scale);

/// Too long for the place where it would stand: shortened there and in full in section 9.
[[nodiscard]] bool isLongText(const std::string& text);
/// A word of the record or what a person typed; of a long text the beginning.
[[nodiscard]] QString shortTerm(const std::string& text, const Speech& say);
/// What a person typed, or "not recorded"; of a long text the beginning.
[[nodiscard]] QString shortEntered(const std::string& text, const Speech& say);

enum class Badge { Plain, Dashed, Ticked };
/// A word in a frame; dashed for what may still change. @return where there is room left of it [mm]
double badge(PageCanvas& canvas, const QPointF& right_top_mm, const QString& text, Badge kind);

/// "SIGNED" or "DRAFT"; the former never without the record's hash.
double stateBadge(PageCanvas& canvas, const ReportContent& content, const QPointF& right_top_mm);

/// "W2 · right foot, plantar, heel".
[[nodiscard]] QString placeLine(int number,
                                ReportSide side,
                                std::initializer_list<std::string> words,
                                const Speech& say);
/// "W1 · right foot, plantar, metatarsal head 2"; needs a record.
[[nodiscard]] QString woundLine(const ReportContent& content, const Speech& say);

}  // namespace tarsus
