#include <QtGui/QPainter>

#include "tests/ui/window/windows.h"

// Takes the pictures of ui/window/pictures, every screen in both languages, and README's first one: `./dev
// screenshots`.

namespace passung::test {
namespace {

using presenter::RunState;

class Pictures : public Windows {
protected:
    QImage keep(QQuickWindow* of, const QString& name) {
        // Twice: what moves into its place has arrived by the second.
        of->grabWindow();
        QCoreApplication::processEvents();
        const QImage image = of->grabWindow();
        image.convertToFormat(QImage::Format_RGB32)
            .save(QString("%1/%2_%3.png").arg(std::getenv("PASSUNG_PICTURES"), name, app_->language()), "PNG", 0);
        return image;
    }

    /// Waits until the trial has gone on for so long that there is something to see.
    void watchTrial(const char* study) {
        click("page-studies");
        click(study);
        click("watch");
        waitFor([&] { return run().view().force_N > 2.0 && run().view().trial_s > 1.5; });
    }
};

/// Side by side, the second one as high as the first.
QImage beside(const QImage& left, const QImage& right) {
    constexpr int kHeight = 640, kGap = 16;
    const QImage a = left.scaledToHeight(kHeight, Qt::SmoothTransformation);
    const QImage b = right.scaledToHeight(kHeight, Qt::SmoothTransformation);
    QImage both(a.width() + kGap + b.width(), kHeight, QImage::Format_RGB32);
    both.fill(Qt::white);
    QPainter painter(&both);
    painter.drawImage(0, 0, a);
    painter.drawImage(a.width() + kGap, 0, b);
    return both;
}

TEST_F(Pictures, OfEveryScreen) {
    ASSERT_NE(std::getenv("PASSUNG_PICTURES"), nullptr) << "the folder that they go to";
    for (const char* language : {"en", "de"}) {
        open(language, true);
        QQuickWindow *console = app_->experimenter(), *participant = app_->participant();
        watchTrial("study-peg_in_hole");
        const QImage view = keep(participant, "participant_task");
        const QImage session = keep(console, "session");
        if (app_->language() == "en")
            beside(session, view).save(QString("%1/overview.png").arg(std::getenv("PASSUNG_PICTURES")), "PNG", 0);
        pressKey(Qt::Key_Escape);
        waitFor(RunState::Stopped);
        keep(console, "session_stopped");
        keep(participant, "participant_pause");
        participant->close();
        waitFor([&] { return run().view().display == presenter::Display::Closed; });
        keep(console, "session_window_closed");
        for (const char* page : {"studies", "participants", "data"}) {
            click(QByteArray("page-") + page);
            keep(console, QString("console_%1").arg(page));
        }
        app_->look().setDark(false);
        click("page-studies");
        keep(console, "console_studies_light");
    }
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
