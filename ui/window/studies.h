#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <string>
#include <vector>

#include "ui/presenter/study_card.h"
#include "ui/window/desk.h"

namespace passung::window {

/// The list of studies for QML, and which of them all pages are about.
class Studies : public QObject {
    Q_OBJECT
    Q_PROPERTY(QVariantList cards READ cards NOTIFY changed)
    Q_PROPERTY(int chosen READ chosen WRITE choose NOTIFY chosenChanged)

public:
    /// `tryouts`: folder of the databases of try-outs.
    Studies(Desk& desk, const std::string& folder, std::string tryouts);

    QVariantList cards() const;
    int chosen() const { return chosen_; }
    void choose(int card);
    /// False: no study has this file.
    bool chooseFile(const QString& path);
    /// Reads all protocols again.
    Q_INVOKABLE void reload();
    /// Runs the study of this card with a pilot at the mouse, or with a simulated participant to look at.
    Q_INVOKABLE void tryOut(int card, bool simulated, const QString& language);
    void retranslate() { emit changed(); }

    /// The chosen study; null: there is none.
    const presenter::StudyCard* card() const;
    /// Databases of its real sessions and of its try-outs, whether they are there or not.
    std::string database() const;
    std::string tryOuts() const;

signals:
    void changed();
    void chosenChanged();

private:
    Desk& desk_;
    std::string folder_, tryouts_;
    std::vector<presenter::StudyCard> cards_;
    int chosen_ = 0;
};

}  // namespace passung::window
