#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <vector>

#include "ui/presenter/study_card.h"
#include "ui/window/desk.h"

namespace passung::window {

/// The list of studies for QML.
class Studies : public QObject {
    Q_OBJECT
    Q_PROPERTY(QVariantList cards READ cards NOTIFY changed)

public:
    Studies(Desk& desk, const std::string& folder);

    QVariantList cards() const;
    /// Runs the study of this card with a pilot at the mouse, or with a simulated participant to look at.
    Q_INVOKABLE void tryOut(int card, bool simulated);
    void retranslate() { emit changed(); }

signals:
    void changed();

private:
    Desk& desk_;
    std::vector<presenter::StudyCard> cards_;
};

}  // namespace passung::window
