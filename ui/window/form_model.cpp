#include "ui/window/form_model.h"

#include "ui/window/text.h"

#include <QtCore/QCoreApplication>
#include <utility>

namespace passung::window {

using presenter::FormFault;
using presenter::FormRow;
using presenter::ItemControl;

namespace {

QString controlName(ItemControl control) {
    switch (control) {
        case ItemControl::Points:
            return QStringLiteral("points");
        case ItemControl::Ticks:
            return QStringLiteral("ticks");
        case ItemControl::Line:
            return QStringLiteral("line");
        case ItemControl::Options:
            return QStringLiteral("options");
        case ItemControl::Pair:
            return QStringLiteral("pair");
        case ItemControl::Decision:
            return QStringLiteral("decision");
        case ItemControl::Number:
            return QStringLiteral("number");
        case ItemControl::Text:
            break;
    }
    return QStringLiteral("text");
}

}  // namespace

FormModel::FormModel(Desk& desk, Speech& speech) : desk_(desk), speech_(speech) {
    clock_.start();
    connect(&desk_, &Desk::happened, this, &FormModel::refresh);
}

/// Another form, none, or one that is hidden by a pause and comes back.
void FormModel::refresh() {
    const auto asked = desk_.run().view().form();
    const bool asks = desk_.run().view().is<presenter::state::Answering, presenter::state::Consenting>();
    if (!asked && !form_) return;
    if (!asked) {
        form_.reset();
    } else if (!form_ || &form_->request() != asked.get()) {
        form_.emplace(asked, now());
        turned_to_.reset();
    }
    visible_ = form_ && !form_->isDone() && asks;
    if (form_ && visible_)
        form_->unhide(now());
    else if (form_)
        form_->hide(now());
    show();
}

void FormModel::show() {
    view_ = form_ ? form_->view() : presenter::FormView{};
    const auto page = form_ ? std::optional(view_.page) : std::nullopt;
    if (std::exchange(turned_to_, page) != page) emit turned();
    emit changed();
    if (!form_ || !form_->isDone()) return;
    desk_.handIn(form_->request().id, form_->filled("participant"));
    visible_ = false;
    emit changed();
}

QString FormModel::title() const {
    return consent() ? speech_(QT_TRANSLATE_NOOP("participant", "Your consent")) : text(view_.title);
}

QVariantList FormModel::rows() const {
    QVariantList all;
    for (const FormRow& row : view_.rows) {
        QStringList labels;
        for (const std::string& label : row.labels) labels.append(text(label));
        if (row.control == ItemControl::Decision)
            labels = {speech_(QT_TRANSLATE_NOOP("participant", "I agree")),
                      speech_(QT_TRANSLATE_NOOP("participant", "I do not agree"))};
        QString range;
        if (row.control == ItemControl::Number)
            range = speech_(QT_TRANSLATE_NOOP("participant", "%1 to %2"))
                        .arg(speech_.number(row.low, 0), speech_.number(row.high, 0));
        QString question = text(row.text);
        if (row.control == ItemControl::Pair)
            question = speech_(QT_TRANSLATE_NOOP("participant", "Which of the two mattered more?"));
        all.append(QVariantMap{{"number", static_cast<int>(row.number)},
                               {"look", controlName(row.control)},
                               {"text", question},
                               {"lowAnchor", text(row.low_anchor)},
                               {"highAnchor", text(row.high_anchor)},
                               {"labels", labels},
                               {"picked", row.picked ? static_cast<int>(*row.picked) : -1},
                               {"low", row.low},
                               {"high", row.high},
                               {"ticks", row.ticks},
                               {"answered", row.value.has_value()},
                               {"value", row.value.value_or(0.0)},
                               {"typed", text(row.typed)},
                               {"range", range},
                               {"fault", faultWord(row)},
                               {"open", row.open},
                               {"beside", row.beside}});
    }
    return all;
}

QString FormModel::faultWord(const FormRow& row) const {
    switch (row.fault) {
        case FormFault::None:
            break;
        case FormFault::NoNumber:
            return speech_(QT_TRANSLATE_NOOP("participant", "Please enter a number."));
        case FormFault::OutOfRange:
            return speech_(QT_TRANSLATE_NOOP("participant", "Please enter a number from %1 to %2."))
                .arg(speech_.number(row.low, 0), speech_.number(row.high, 0));
    }
    return {};
}

QString FormModel::notice() const {
    if (view_.open == 0) return {};
    if (view_.consent) return speech_(QT_TRANSLATE_NOOP("participant", "Please decide first."));
    return speech_(QT_TRANSLATE_NOOP("participant", "Not answered yet: %1. Going on once more leaves that out."))
        .arg(view_.open);
}

QString FormModel::backWord() const { return speech_(QT_TRANSLATE_NOOP("participant", "Back")); }

QString FormModel::nextWord() const {
    return view_.last() ? speech_(QT_TRANSLATE_NOOP("participant", "Done"))
                        : speech_(QT_TRANSLATE_NOOP("participant", "Next"));
}

QString FormModel::pageWord() const {
    return speech_(QT_TRANSLATE_NOOP("participant", "Page %1 of %2")).arg(view_.page + 1).arg(view_.pages);
}

void FormModel::pick(int row, int label) {
    if (!form_) return;
    form_->pick(static_cast<std::size_t>(row), static_cast<std::size_t>(label), now());
    show();
}

void FormModel::place(int row, double value) {
    if (!form_) return;
    form_->place(static_cast<std::size_t>(row), value, now());
    show();
}

void FormModel::type(int row, const QString& typed) {
    if (form_) form_->type(static_cast<std::size_t>(row), typed.toStdString(), now());
}

void FormModel::focusOn(int row) {
    if (!form_ || row == focus()) return;
    form_->focus(static_cast<std::size_t>(row));
    show();
}

void FormModel::enter() {
    if (!form_) return;
    form_->enter();
    show();
}

void FormModel::next() {
    if (!form_) return;
    form_->next(now());
    show();
}

void FormModel::back() {
    if (!form_) return;
    form_->back(now());
    show();
}

bool FormModel::key(int row, int key) {
    if (!form_) return false;
    const auto at = static_cast<std::size_t>(row);
    switch (key) {
        case Qt::Key_Right:
        case Qt::Key_Down:
            form_->step(at, 1, now());
            break;
        case Qt::Key_Left:
        case Qt::Key_Up:
            form_->step(at, -1, now());
            break;
        case Qt::Key_Home:
        case Qt::Key_End:
            form_->end(at, key == Qt::Key_End, now());
            break;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            form_->enter();
            break;
        default:
            if (key < Qt::Key_0 || key > Qt::Key_9 || !form_->digit(at, key - Qt::Key_0, now())) return false;
    }
    show();
    return true;
}

void FormModel::button(int number) {
    if (!form_) return;
    form_->button(number, now());
    show();
}

}  // namespace passung::window
