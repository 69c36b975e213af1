#include "ui/window/study_words.h"

#include <QtCore/QCoreApplication>
#include <QtCore/QStringList>
#include <cmath>

#include "ui/window/words.h"

namespace passung::window {

namespace {

QString said(const char* text) { return QCoreApplication::translate("study", text); }

QString orderWord(plan::BlockOrder order) {
    switch (order) {
        case plan::BlockOrder::Williams:
            return said(QT_TRANSLATE_NOOP("study", "Williams square"));
        case plan::BlockOrder::Permutations:
            return said(QT_TRANSLATE_NOOP("study", "all orders"));
        case plan::BlockOrder::Random:
            return said(QT_TRANSLATE_NOOP("study", "each pass in random order"));
        case plan::BlockOrder::Shuffled:
            return said(QT_TRANSLATE_NOOP("study", "all trials shuffled"));
        case plan::BlockOrder::Listed:
            break;
    }
    return said(QT_TRANSLATE_NOOP("study", "as listed"));
}

/// What the core calls its stages and why it runs them: looked up by the very words.
[[maybe_unused]] constexpr const char* kStages[] = {
    QT_TRANSLATE_NOOP("stages", "input guard"),
    QT_TRANSLATE_NOOP("stages", "always: a device may lie, stall or vanish"),
    QT_TRANSLATE_NOOP("stages", "energy account"),
    QT_TRANSLATE_NOOP("stages", "always: what the controller takes in and gives out at the handle is recorded"),
    QT_TRANSLATE_NOOP("stages", "start gate"),
    QT_TRANSLATE_NOOP("stages", "start_gate is set: contact begins when the hand holds the start pose"),
    QT_TRANSLATE_NOOP("stages", "free hand"),
    QT_TRANSLATE_NOOP("stages", "the scene has no obstacle"),
    QT_TRANSLATE_NOOP("stages", "contacts at the hand"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is penalty: forces come from the overlap at the device's own pose; "
                      "contact.two_way: of the held part's points and of the obstacles' points"),
    QT_TRANSLATE_NOOP("stages", "contact.method is penalty: forces come from the overlap at the device's own pose"),
    QT_TRANSLATE_NOOP("stages", "penalty wrench"),
    QT_TRANSLATE_NOOP("stages", "turns the overlap into force and torque by contact.variant"),
    QT_TRANSLATE_NOOP("stages", "penalty tool"),
    QT_TRANSLATE_NOOP(
        "stages", "contact.coupling is virtual: a tool with mass between the hand's spring and the contacts' penalty"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.coupling is quasi_static: a tool where the hand's spring and the contacts' penalty "
                      "balance"),
    QT_TRANSLATE_NOOP("stages", "proxy correction"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy and relief "
                      "of its overlap; contact.two_way: here and below of the held part's points and of the obstacles' "
                      "points"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy and relief "
                      "of its overlap"),
    QT_TRANSLATE_NOOP("stages", "proxy motion"),
    QT_TRANSLATE_NOOP("stages", "steps #3 and #4: the proxy follows the hand as far as the contacts let it"),
    QT_TRANSLATE_NOOP("stages", "proxy sweep"),
    QT_TRANSLATE_NOOP(
        "stages",
        "contact.method is god_object: the proxy follows the hand as far as all contacts within reach let "
        "it; contact.two_way: of the held part's points and of the obstacles' points"),
    QT_TRANSLATE_NOOP(
        "stages",
        "contact.method is god_object: the proxy follows the hand as far as all contacts within reach let "
        "it"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.budget_nodes with god_object_heuristic: the proxy goes the way of god_object, which can "
                      "stop in a look and go on in the next tick"),
    QT_TRANSLATE_NOOP("stages", "proxy filter"),
    QT_TRANSLATE_NOOP("stages", "contact.proxy_filter_hz is set: a low-pass of the proxy in contact"),
    QT_TRANSLATE_NOOP("stages", "proxy record"),
    QT_TRANSLATE_NOOP("stages", "overlap and contacts at the proxy, for the record"),
    QT_TRANSLATE_NOOP("stages", "overlap and contacts at the proxy, and its lag, for the record"),
    QT_TRANSLATE_NOOP("stages", "hand depth"),
    QT_TRANSLATE_NOOP("stages", "the overlap at the device's pose is measured and recorded"),
    QT_TRANSLATE_NOOP("stages", "closed-form proxy"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object and all pairs have a closed form: the proxy follows the hand as "
                      "far as the shapes' faces and edges let it; no distance field, no points"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object_heuristic and all pairs have a closed form: steps #1 to #4 on the "
                      "shapes' faces and edges; no distance field, no points"),
    QT_TRANSLATE_NOOP("stages", "closed-form filter"),
    QT_TRANSLATE_NOOP("stages", "common way"),
    QT_TRANSLATE_NOOP("stages", "closed-form common way"),
    QT_TRANSLATE_NOOP("stages", "parts in different hands move in one tick: their common way is free too"),
    QT_TRANSLATE_NOOP("stages", "closed-form record"),
    QT_TRANSLATE_NOOP("stages", "closed-form hand depth"),
    QT_TRANSLATE_NOOP("stages", "surface proxy"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object and contact is that of surfaces: the proxy follows the hand as far "
                      "as no triangles meet; no distance field, no points"),
    QT_TRANSLATE_NOOP("stages",
                      "contact.method is god_object_heuristic and contact is that of surfaces: the proxy follows the "
                      "hand as far as no triangles meet; no distance field, no points"),
    QT_TRANSLATE_NOOP("stages", "surface record"),
    QT_TRANSLATE_NOOP("stages", "the proven gap and the contacts at the proxy, for the record"),
    QT_TRANSLATE_NOOP("stages", "surface hand depth"),
    QT_TRANSLATE_NOOP("stages", "the way from proxy to hand along what holds it is recorded"),
    QT_TRANSLATE_NOOP("stages", "virtual coupling"),
    QT_TRANSLATE_NOOP("stages", "spring and damper between proxy and hand"),
    QT_TRANSLATE_NOOP("stages", "contact transients"),
    QT_TRANSLATE_NOOP("stages", "effects.transients is set: a decaying vibration is added at every impact"),
    QT_TRANSLATE_NOOP("stages", "weight"),
    QT_TRANSLATE_NOOP(
        "stages", "effects.weight is set: the proxy hangs from the hand as far as its weight stretches the coupling"),
    QT_TRANSLATE_NOOP("stages", "effects.weight is set: no proxy hangs from the hand, which holds the part itself"),
    QT_TRANSLATE_NOOP("stages", "navigation"),
    QT_TRANSLATE_NOOP("stages",
                      "effects.clutch, effects.position_scale or effects.drift is set: the hand's place in the scene "
                      "follows them"),
    QT_TRANSLATE_NOOP("stages", "sign of contact"),
    QT_TRANSLATE_NOOP("stages", "effects.position_scale or effects.drift is set: both wait while parts touch"),
    QT_TRANSLATE_NOOP("stages", "clutched wrench"),
    QT_TRANSLATE_NOOP("stages", "effects.clutch is set: the wrench fades while the clutch is held"),
    QT_TRANSLATE_NOOP("stages", "weight in the hand"),
    QT_TRANSLATE_NOOP("stages", "effects.weight is set: what no contact carries is felt"),
    QT_TRANSLATE_NOOP("stages", "viscosity"),
    QT_TRANSLATE_NOOP("stages", "effects.viscosity is set: a damper resists the held part's motion"),
    QT_TRANSLATE_NOOP("stages", "guidance"),
    QT_TRANSLATE_NOOP("stages", "effects.guidance has a share above 0: a guide draws the hand along"),
    QT_TRANSLATE_NOOP("stages", "snap"),
    QT_TRANSLATE_NOOP("stages", "effects.snap is set: near its place the held part is drawn into it"),
    QT_TRANSLATE_NOOP("stages", "inertia"),
    QT_TRANSLATE_NOOP("stages", "effects.inertia is set: the proxy is a mass on the coupling's spring"),
    QT_TRANSLATE_NOOP("stages", "keeping apart"),
    QT_TRANSLATE_NOOP("stages", "effects.keep_apart is set: parts in two hands push each other away before they touch"),
    QT_TRANSLATE_NOOP("stages", "sum of effects"),
    QT_TRANSLATE_NOOP("stages", "an effect adds to the wrench"),
    QT_TRANSLATE_NOOP("stages", "pushes between hands"),
    QT_TRANSLATE_NOOP("stages", "parts in different hands may touch: what pushes them is accounted for"),
    QT_TRANSLATE_NOOP("stages", "contact shares"),
    QT_TRANSLATE_NOOP("stages", "always: the energy account is kept for each obstacle too"),
    QT_TRANSLATE_NOOP("stages", "output delay"),
    QT_TRANSLATE_NOOP("stages", "device.delay_ticks is set"),
    QT_TRANSLATE_NOOP("stages", "passivity controller"),
    QT_TRANSLATE_NOOP("stages", "effects.passivity_controller is set: a damper takes back energy that was given out"),
    QT_TRANSLATE_NOOP("stages", "no wrench"),
    QT_TRANSLATE_NOOP("stages", "feedback.kinesthetic is false: contact is computed, nothing is displayed"),
    QT_TRANSLATE_NOOP("stages", "output limits"),
    QT_TRANSLATE_NOOP("stages", "always, last: finite, within the device's limits, rising slowly enough"),
};

}  // namespace

QString blockWords(const presenter::BlockLine& block, std::size_t sessions) {
    QStringList words{phaseWord(plan::phaseName(block.phase))};
    words << (block.adaptive ? said(QT_TRANSLATE_NOOP("study", "staircase")) : orderWord(block.order));
    if (!block.adaptive) words << said(QT_TRANSLATE_NOOP("study", "passes: %1")).arg(block.repetitions);
    if (sessions > 1) words << said(QT_TRANSLATE_NOOP("study", "session %1")).arg(block.session);
    if (block.rest_s > 0.0) words << said(QT_TRANSLATE_NOOP("study", "after %1 s of rest")).arg(block.rest_s);
    return words.join(QStringLiteral(", "));
}

QString durationLine(const std::vector<double>& minutes) {
    QStringList each;
    for (const double m : minutes) each << QString::number(std::ceil(m));
    return said(QT_TRANSLATE_NOOP("study",
                                  "About %1 min a participant with every trial to its time-out and shortest rests; "
                                  "ways to the start, repeats and questionnaires come on top."))
        .arg(each.join(QStringLiteral(" + ")));
}

QString stageWord(const std::string& text) { return QCoreApplication::translate("stages", text.c_str()); }

QString accuracyHint(bool asked_for) {
    if (asked_for)
        return said(QT_TRANSLATE_NOOP("study",
                                      "This study picks its accuracy by itself when its first session begins: "
                                      "every setting is then measured on this machine and kept here."));
    return said(QT_TRANSLATE_NOOP(
        "study",
        "Nothing was measured yet. Measuring lets a simulated hand do a trial of the condition, runs the tick along "
        "its way with every method and geometry that the parts can have, and shows what each costs and how true it "
        "is. It takes minutes; the window can be used meanwhile."));
}

QString pickLine(const presenter::AccuracyPoint& point, double budget_us) {
    return said(QT_TRANSLATE_NOOP("study", "Budget %1 µs: %2, tolerance %3 µm, spacing %4 mm – %5 µs, error %6 µm"))
        .arg(budget_us)
        .arg(QString::fromStdString(point.mode))
        .arg(point.tolerance_um, 0, 'g', 3)
        .arg(point.spacing_mm, 0, 'g', 3)
        .arg(point.time_us, 0, 'f', 1)
        .arg(point.error_um, 0, 'f', 1);
}

QString loopVerdict(run::LoopFitness fitness) {
    switch (fitness) {
        case run::LoopFitness::Studies:
            return said(QT_TRANSLATE_NOOP("study", "Fit for studies."));
        case run::LoopFitness::StudiesIfAlone:
            return said(
                QT_TRANSLATE_NOOP("study", "Good now, but without real-time scheduling another program can spoil it."));
        case run::LoopFitness::TryOuts:
            return said(QT_TRANSLATE_NOOP("study", "Fit for trying out, not for studies."));
        case run::LoopFitness::Nothing:
            break;
    }
    return said(QT_TRANSLATE_NOOP(
        "study", "Not fit: close other programs, grant real-time scheduling, or use another machine."));
}

QString whyNotMeasure(WhyNotMeasure why) {
    switch (why) {
        case WhyNotMeasure::NotSound:
            return said(QT_TRANSLATE_NOOP("study", "The study has problems."));
        case WhyNotMeasure::SessionRuns:
            return said(QT_TRANSLATE_NOOP("study", "A session is running."));
        case WhyNotMeasure::Measures:
            break;
    }
    return said(QT_TRANSLATE_NOOP("study", "Measuring …"));
}

}  // namespace passung::window
