#include "ui/window/look.h"

#include <QtGui/QFontDatabase>

namespace passung::window {

namespace {

QString firstOf(const QStringList& wanted, QFontDatabase::SystemFont otherwise) {
    const QStringList there = QFontDatabase::families();
    for (const QString& family : wanted)
        if (there.contains(family)) return family;
    return QFontDatabase::systemFont(otherwise).family();
}

}  // namespace

Look::Look(bool dark)
    : dark_(dark),
      family_(firstOf({"Inter", "Noto Sans", "DejaVu Sans"}, QFontDatabase::GeneralFont)),
      digits_(firstOf({"JetBrains Mono", "DejaVu Sans Mono"}, QFontDatabase::FixedFont)) {}

void Look::setScale(double scale) {
    if (scale == scale_) return;
    scale_ = scale;
    emit changed();
}

void Look::setDark(bool dark) {
    if (dark == dark_) return;
    dark_ = dark;
    emit changed();
}

}  // namespace passung::window
