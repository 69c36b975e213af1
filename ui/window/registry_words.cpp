#include "ui/window/registry_words.h"

#include <QtCore/QCoreApplication>

namespace passung::window {

namespace {

/// Labels of all measures: looked up by the very words.
[[maybe_unused]] constexpr const char* kMeasures[] = {
    QT_TRANSLATE_NOOP("measures", "Success"),
    QT_TRANSLATE_NOOP("measures", "Completion time"),
    QT_TRANSLATE_NOOP("measures", "Trial time"),
    QT_TRANSLATE_NOOP("measures", "Time to success, or to the end without one"),
    QT_TRANSLATE_NOOP("measures", "Whether the time ended in success"),
    QT_TRANSLATE_NOOP("measures", "Approach time"),
    QT_TRANSLATE_NOOP("measures", "Search time"),
    QT_TRANSLATE_NOOP("measures", "Insertion time"),
    QT_TRANSLATE_NOOP("measures", "Insertion depth"),
    QT_TRANSLATE_NOOP("measures", "Path length of the hand"),
    QT_TRANSLATE_NOOP("measures", "Path length over the straight distance"),
    QT_TRANSLATE_NOOP("measures", "Rotation path of the hand"),
    QT_TRANSLATE_NOOP("measures", "Smoothness: spectral arc length (SPARC)"),
    QT_TRANSLATE_NOOP("measures", "Smoothness: log dimensionless jerk"),
    QT_TRANSLATE_NOOP("measures", "Contact onsets"),
    QT_TRANSLATE_NOOP("measures", "Contact time"),
    QT_TRANSLATE_NOOP("measures", "Contact time outside the hole"),
    QT_TRANSLATE_NOOP("measures", "Mean force"),
    QT_TRANSLATE_NOOP("measures", "Peak force"),
    QT_TRANSLATE_NOOP("measures", "Force, 99th percentile"),
    QT_TRANSLATE_NOOP("measures", "Mean torque"),
    QT_TRANSLATE_NOOP("measures", "Peak torque"),
    QT_TRANSLATE_NOOP("measures", "Torque, 99th percentile"),
    QT_TRANSLATE_NOOP("measures", "Mean depth at the hand's pose"),
    QT_TRANSLATE_NOOP("measures", "Largest depth at the hand's pose"),
    QT_TRANSLATE_NOOP("measures", "Depth at the hand's pose, 99th percentile"),
    QT_TRANSLATE_NOOP("measures", "Mean depth at the proxy's pose"),
    QT_TRANSLATE_NOOP("measures", "Largest depth at the proxy's pose"),
    QT_TRANSLATE_NOOP("measures", "Depth at the proxy's pose, 99th percentile"),
    QT_TRANSLATE_NOOP("measures", "Least proven gap at the proxy's pose"),
    QT_TRANSLATE_NOOP("measures", "Largest true overlap of what was shown"),
    QT_TRANSLATE_NOOP("measures", "Share of contact ticks with a true overlap"),
    QT_TRANSLATE_NOOP("measures", "Impulse"),
    QT_TRANSLATE_NOOP("measures", "Work of the hand"),
    QT_TRANSLATE_NOOP("measures", "Share of ticks at the force limit"),
    QT_TRANSLATE_NOOP("measures", "Ticks on the last good pose after a bad sample"),
    QT_TRANSLATE_NOOP("measures", "Ticks without usable device input, hence without force"),
    QT_TRANSLATE_NOOP("measures", "Ticks for which the device had nothing new"),
    QT_TRANSLATE_NOOP("measures", "Ticks without force because a computed one was not finite"),
    QT_TRANSLATE_NOOP("measures", "Ticks at the limit of force or torque"),
    QT_TRANSLATE_NOOP("measures", "Ticks at the limit of rising force"),
    QT_TRANSLATE_NOOP("measures", "Ticks in which the passivity controller acted"),
    QT_TRANSLATE_NOOP("measures", "Ticks whose work went on in the next one: the proxy lags"),
    QT_TRANSLATE_NOOP("measures", "Followed share of the line"),
    QT_TRANSLATE_NOOP("measures", "Deviation from the line"),
    QT_TRANSLATE_NOOP("measures", "Largest deviation from the line"),
    QT_TRANSLATE_NOOP("measures", "Force while following"),
    QT_TRANSLATE_NOOP("measures", "Deviation from the asked force"),
    QT_TRANSLATE_NOOP("measures", "Stimuli of the secondary task"),
    QT_TRANSLATE_NOOP("measures", "Share of stimuli that were answered"),
    QT_TRANSLATE_NOOP("measures", "Mean response time of the secondary task"),
    QT_TRANSLATE_NOOP("measures", "Presses that answer no stimulus"),
    QT_TRANSLATE_NOOP("measures", "Interval with the comparison"),
    QT_TRANSLATE_NOOP("measures", "Interval that was named"),
    QT_TRANSLATE_NOOP("measures", "The comparison was named"),
    QT_TRANSLATE_NOOP("measures", "Response time"),
    QT_TRANSLATE_NOOP("measures", "Time in the passage"),
    QT_TRANSLATE_NOOP("measures", "Path in the passage"),
    QT_TRANSLATE_NOOP("measures", "Contact time in the passage"),
    QT_TRANSLATE_NOOP("measures", "Peak force in the passage"),
    QT_TRANSLATE_NOOP("measures", "Entries into the passage"),
    QT_TRANSLATE_NOOP("measures", "Position error at the confirmation"),
    QT_TRANSLATE_NOOP("measures", "Angle error at the confirmation"),
    QT_TRANSLATE_NOOP("measures", "Steps done"),
    QT_TRANSLATE_NOOP("measures", "Errors of order"),
    QT_TRANSLATE_NOOP("measures", "Parts let go elsewhere"),
    QT_TRANSLATE_NOOP("measures", "Parts taken again"),
    QT_TRANSLATE_NOOP("measures", "Steps taken back"),
    QT_TRANSLATE_NOOP("measures", "Hints"),
    QT_TRANSLATE_NOOP("measures", "Way of the parts over free paths"),
};

/// Labels of all devices, likewise.
[[maybe_unused]] constexpr const char* kDevices[] = {
    QT_TRANSLATE_NOOP("devices", "Force Dimension sigma.7 (simulated)"),
    QT_TRANSLATE_NOOP("devices", "DLR HUG, one arm (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Haption Virtuose 6D35-45 (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Novint Falcon (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Wearable haptic interface, TU Berlin and DLR (simulated)"),
    QT_TRANSLATE_NOOP("devices", "3D Systems Touch, formerly Phantom Omni (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Haply Inverse3 with a grip (simulated)"),
    QT_TRANSLATE_NOOP("devices", "3Dconnexion SpaceMouse (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Tracker of six degrees without motors (simulated)"),
    QT_TRANSLATE_NOOP("devices", "Any device (simulated)"),
};

}  // namespace

QString measureWord(const std::string& label) { return QCoreApplication::translate("measures", label.c_str()); }
QString deviceWord(const std::string& label) { return QCoreApplication::translate("devices", label.c_str()); }

}  // namespace passung::window
