#include <QtGui/QPainter>

#include <map>

#include "tests/ui/window/tour.h"

// Takes the pictures of ui/window/pictures, every screen in both languages, and README's first one: `./dev
// screenshots`.

namespace passung::test {
namespace {

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

class Pictures : public Tour {
protected:
    static constexpr int kWidth = 1280, kHeight = 800;

    void keep(QQuickWindow* of, const QString& name, bool dark) {
        if (of->width() > kWidth) {
            of->resize(kWidth, kHeight);
            waitFor([&] { return of->width() == kWidth; });
        }
        // Twice: what moves into its place has arrived by the second.
        of->grabWindow();
        QCoreApplication::processEvents();
        const QImage image = of->grabWindow().convertToFormat(QImage::Format_RGB32);
        save(image, QString("%1_%2_%3").arg(name, app_->language(), dark ? "dark" : "light"));
        taken_[name] = image;
    }

    void save(const QImage& image, const QString& name) {
        ASSERT_TRUE(image.save(QString("%1/%2.png").arg(std::getenv("PASSUNG_PICTURES"), name), "PNG", 0))
            << name.toStdString();
    }

    std::map<QString, QImage> taken_;
};

TEST_F(Pictures, OfEveryScreen) {
    ASSERT_NE(std::getenv("PASSUNG_PICTURES"), nullptr) << "the folder that they go to";
    const bool all = std::getenv("PASSUNG_ALL_PICTURES") != nullptr;  // else each language in one light
    for (const char* language : {"en", "de"}) {
        for (const bool dark : {true, false}) {
            if (!all && dark != (std::string(language) == "en")) continue;
            takeTour(language, dark, 1.0, [&](QQuickWindow* of, const QString& name) { keep(of, name, dark); });
            if (dark && app_->language() == "en")
                save(beside(taken_["console_session"], taken_["participant_task"]), "overview");
        }
    }
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
