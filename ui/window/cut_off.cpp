#include "ui/window/cut_off.h"

namespace passung::window {

namespace {

constexpr const char* kStudy = "running/study";  // its file
constexpr const char* kCode = "running/code";

}  // namespace

CutOff::CutOff(Desk& desk, Studies& studies, ParticipantsModel& participants, QSettings& memory)
    : desk_(desk), studies_(studies), participants_(participants), memory_(memory) {
    connect(&participants_, &ParticipantsModel::began, this, [this](const QString& study, const QString& code) {
        leave();
        memory_.setValue(kStudy, study);
        memory_.setValue(kCode, code);
        memory_.sync();  // whatever ends the program from here on
    });
    connect(&desk_, &Desk::happened, this, [this] {
        if (desk_.run().view().isOver()) forget();
    });
    connect(&participants_, &ParticipantsModel::changed, this, &CutOff::changed);
}

void CutOff::forget() {
    if (!memory_.contains(kStudy)) return;
    memory_.remove("running");
    memory_.sync();
}

void CutOff::close() {
    if (code_.isEmpty()) forget();
}

bool CutOff::find() {
    if (!memory_.contains(kStudy) || !studies_.chooseFile(memory_.value(kStudy).toString())) return false;
    code_ = memory_.value(kCode).toString();
    participants_.select(code_);
    emit changed();
    return true;
}

/// Of whom it was, as long as they are the ones whom the page is about.
QString CutOff::about(const char* what) const {
    const QVariantMap person = participants_.person();
    return code_.isEmpty() || person["code"].toString() != code_ ? QString() : person[what].toString();
}

bool CutOff::resume(const QString& language) { return !question().isEmpty() && participants_.start(true, language); }

void CutOff::leave() {
    if (code_.isEmpty()) return;
    code_.clear();
    forget();
    emit changed();
}

}  // namespace passung::window
