#include "ui/window/accuracy_words.h"

#include <QtCore/QCoreApplication>
#include <QtCore/QFileInfo>
#include <QtCore/QLocale>
#include <QtCore/QStringList>
#include <cmath>

#include "core/scene/contact_geometry.h"
#include "ui/window/text.h"

namespace passung::window {

namespace {

QString said(const char* words) { return QCoreApplication::translate("accuracy", words); }

QString placeOf(const Error& error) {
    return QStringLiteral("%1:%2").arg(QFileInfo(text(error.file)).fileName()).arg(error.line);
}

/// `resolution`, `spacing`: with a place for their numbers.
QString fieldWords(const truth::TickSetting& setting, const QString& resolution, const QString& spacing) {
    const auto& field = setting.field;
    QStringList words{resolution, spacing.arg(1e3 * field.spacing, 0, 'g', 4),
                      QString::fromLatin1(field::modeName(field.mode))};
    if (setting.two_way) words << said(QT_TRANSLATE_NOOP("accuracy", "both ways"));
    if (field.budget_nodes > 0) words << said(QT_TRANSLATE_NOOP("accuracy", "%1 nodes")).arg(field.budget_nodes);
    return words.join(QStringLiteral(" · "));
}

}  // namespace

QString numberWord(double value) {
    if (!std::isfinite(value)) return QStringLiteral("–");
    const int whole = value >= 1.0 ? static_cast<int>(std::floor(std::log10(value))) + 1 : 1;
    return QString::number(value, 'f', std::max(0, value >= 100.0 ? 0 : 3 - whole));
}

QString detailWords(const truth::TickSetting& setting, double cell) {
    if (setting.geometry != scene::Geometry::Field) return {};
    const QString resolution =
        cell > 0.0 ? said(QT_TRANSLATE_NOOP("accuracy", "cell %1 mm")).arg(1e3 * cell, 0, 'g', 4)
                   : said(QT_TRANSLATE_NOOP("accuracy", "%1 µm")).arg(1e6 * setting.field.tolerance, 0, 'g', 4);
    return fieldWords(setting, resolution, said(QT_TRANSLATE_NOOP("accuracy", "%1 mm")));
}

QString settingWords(const truth::TickSetting& setting, double cell) {
    QStringList words{QString::fromLatin1(scene::methodName(setting.method)),
                      QString::fromLatin1(scene::geometryName(setting.geometry))};
    if (setting.geometry != scene::Geometry::Field) return words.join(QStringLiteral(" · "));
    const QString resolution =
        cell > 0.0
            ? said(QT_TRANSLATE_NOOP("accuracy", "cells of %1 mm")).arg(1e3 * cell, 0, 'g', 4)
            : said(QT_TRANSLATE_NOOP("accuracy", "tolerance %1 µm")).arg(1e6 * setting.field.tolerance, 0, 'g', 4);
    words << fieldWords(setting, resolution, said(QT_TRANSLATE_NOOP("accuracy", "points %1 mm apart")));
    return words.join(QStringLiteral(" · "));
}

QString costWords(const truth::PathCost& row, double cell) {
    const QString setting = settingWords(row.setting, cell);
    const QString time =
        said(QT_TRANSLATE_NOOP("accuracy", "median %1 µs, 99.9 % of ticks below %2 µs, most %3 µs"))
            .arg(numberWord(1e6 * row.time.median), numberWord(1e6 * row.time.p999), numberWord(1e6 * row.time.max));
    const QString overlap =
        std::isfinite(row.overlap_bound)
            ? said(QT_TRANSLATE_NOOP("accuracy", "true overlap at most %1 µm")).arg(numberWord(1e6 * row.overlap_bound))
            : QString();
    const QString force = std::isfinite(row.force.p99)
                              ? said(QT_TRANSLATE_NOOP("accuracy", "force wrong by %1 % (99 % of ticks below)"))
                                    .arg(numberWord(100.0 * row.force.p99))
                              : QString();
    QStringList all{time};
    for (const QString& words : {overlap, force})
        if (!words.isEmpty()) all << words;
    all << said(QT_TRANSLATE_NOOP("accuracy", "%1 MB")).arg(numberWord(1e-6 * row.bytes));
    if (row.suspended > 0)
        all << said(QT_TRANSLATE_NOOP("accuracy", "%1 of %2 ticks end in the next one"))
                   .arg(row.suspended)
                   .arg(row.ticks);
    return setting + QStringLiteral(": ") + all.join(QStringLiteral("; "));
}

QString pathWord() { return said(QT_TRANSLATE_NOOP("accuracy", "the hand's path")); }

QString pathWords(const run::TickFront& front) {
    const double seconds = 1e-3 * static_cast<double>(front.ticks);
    const QString words =
        front.path == run::HandPath::Origin::SimulatedHand
            ? said(QT_TRANSLATE_NOOP("accuracy", "Measured along a simulated hand's way in a trial, %1 s."))
            : said(QT_TRANSLATE_NOOP(
                  "accuracy",
                  "Measured while the held part is pressed 2 mm into the nearest obstacle and slides, %1 s."));
    return words.arg(seconds, 0, 'f', 1);
}

QString originWords(const run::FrontOrigin& origin) {
    const QString program = text(origin.commit.empty() ? origin.program : origin.program + ", " + origin.commit);
    const QString where =
        origin.elsewhere
            ? said(QT_TRANSLATE_NOOP("accuracy", "Measured on another machine (%1) by passung %2 on %3."))
            : said(QT_TRANSLATE_NOOP("accuracy", "Measured before on this machine (%1) by passung %2 on %3."));
    // Not one after another: a name may hold a place of its own.
    QString words = where.arg(text(origin.machine), program, text(origin.date));
    if (!origin.outdated) return words;
    return words + QLatin1Char(' ') +
           said(QT_TRANSLATE_NOOP("accuracy", "The study has changed since: measure again to be sure."));
}

QString leftWords(double seconds) {
    return seconds < 60.0 ? said(QT_TRANSLATE_NOOP("accuracy", "about %1 s left")).arg(10.0 * std::ceil(seconds / 10.0))
                          : said(QT_TRANSLATE_NOOP("accuracy", "about %1 min left")).arg(std::ceil(seconds / 60.0));
}

QString noErrorWords(presenter::TickError error) {
    return error == presenter::TickError::Overlap
               ? said(QT_TRANSLATE_NOOP("accuracy", "The scene has no obstacle: nothing can overlap."))
               : said(
                     QT_TRANSLATE_NOOP("accuracy",
                                       "No force to compare with: it is known for a ball among solids without hollows, "
                                       "and for a round peg in a bore."));
}

QString outcomeWords(const run::OperatingPoint& point) {
    switch (point.outcome) {
        case run::OperatingPoint::Outcome::Written:
            return said(QT_TRANSLATE_NOOP("accuracy", "Written into the study's file."));
        case run::OperatingPoint::Outcome::SaidAlready:
            return said(QT_TRANSLATE_NOOP("accuracy", "The study says so already: nothing was written."));
        case run::OperatingPoint::Outcome::FileChanged:
            return said(QT_TRANSLATE_NOOP(
                "accuracy",
                "Nothing was written: the file has changed since it was measured. Read it again and measure."));
        case run::OperatingPoint::Outcome::Begun:
            return said(QT_TRANSLATE_NOOP(
                "accuracy", "Nothing was written: the study has begun, its database holds what it runs by."));
        case run::OperatingPoint::Outcome::SetElsewhere:
            return said(QT_TRANSLATE_NOOP("accuracy",
                                          "Nothing was written: %1 is set at %2, by a factor, a block or a staircase."))
                .arg(text(point.problem.key), placeOf(point.problem));
        case run::OperatingPoint::Outcome::Refused:
            break;
    }
    return said(QT_TRANSLATE_NOOP("accuracy", "Nothing was written: %1")).arg(text(toString(point.problem)));
}

QString noFrontWords(WhyNoFront why) {
    return why == WhyNoFront::RealParts
               ? said(QT_TRANSLATE_NOOP("accuracy",
                                        "The trials of this condition are done with real parts: choose another one."))
               : said(QT_TRANSLATE_NOOP("accuracy", "Measuring was given up, since a session began."));
}

QString whyNotUse(WhyNotUse why) {
    return why == WhyNotUse::NothingChosen ? said(QT_TRANSLATE_NOOP("accuracy", "Choose a setting first."))
                                           : said(QT_TRANSLATE_NOOP("accuracy", "Writing …"));
}

}  // namespace passung::window
