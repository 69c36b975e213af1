#include <xcb/randr.h>
#include <xcb/xcb.h>
#include <xcb/xcbext.h>

#include <QtCore/QSettings>
#include <QtGui/QScreen>
#include <QtQml/QQmlContext>
#include <cstdlib>
#include <cstring>
#include <tuple>
#include <vector>

#include "tests/ui/window/windows.h"

// Several monitors, as the X server tells programs of them: on which the participant's window is shown.

namespace passung::test {
namespace {

namespace state = presenter::state;

/// Tells the server of a monitor; what xcb itself offers for that counts a request's length wrong (libxcb 1.15).
bool setMonitor(xcb_connection_t* connection, xcb_window_t root, xcb_randr_monitor_info_t monitor,
                xcb_randr_output_t output) {
    std::vector<std::uint32_t> words(2 + sizeof monitor / 4 + monitor.nOutput, output);
    words[1] = root;
    std::memcpy(&words[2], &monitor, sizeof monitor);
    xcb_protocol_request_t request{1, &xcb_randr_id, XCB_RANDR_SET_MONITOR, 1};
    iovec parts[3] = {};  // the first two are xcb's own
    parts[2] = {words.data(), 4 * words.size()};
    const xcb_void_cookie_t cookie{xcb_send_request(connection, XCB_REQUEST_CHECKED, &parts[2], &request)};
    return xcb_request_check(connection, cookie) == nullptr && xcb_connection_has_error(connection) == 0;
}

/// Tells all programs that the screen is three monitors: two side by side, and one below the right one.
void splitScreen() {
    xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
    const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(connection)).data->root;
    auto* resources =
        xcb_randr_get_screen_resources_reply(connection, xcb_randr_get_screen_resources(connection, root), nullptr);
    const xcb_randr_output_t output = xcb_randr_get_screen_resources_outputs(resources)[0];
    std::free(resources);
    for (const auto& [name, place, outputs] :
         {std::tuple{"LEFT", QRect(0, 0, 1600, 1000), 1}, std::tuple{"RIGHT", QRect(1600, 0, 1280, 720), 0},
          std::tuple{"LOW", QRect(1600, 720, 1280, 280), 0}}) {
        auto* atom = xcb_intern_atom_reply(
            connection, xcb_intern_atom(connection, 0, static_cast<std::uint16_t>(std::strlen(name)), name), nullptr);
        xcb_randr_monitor_info_t info{};
        info.name = atom->atom;
        info.primary = outputs == 1;
        info.nOutput = static_cast<std::uint16_t>(outputs);
        info.x = static_cast<std::int16_t>(place.x());
        info.y = static_cast<std::int16_t>(place.y());
        info.width = static_cast<std::uint16_t>(place.width());
        info.height = static_cast<std::uint16_t>(place.height());
        info.width_in_millimeters = 400, info.height_in_millimeters = 250;
        if (!setMonitor(connection, root, info, output))
            throw std::runtime_error("the X server has no monitors to set");
        std::free(atom);
    }
    // The connection stays: a server whose last client goes forgets its monitors.
}

class Screens : public Windows {
protected:
    Screens() { quality_ = presenter::PictureQuality{false, 1, 0.5}; }  // where, not how, it is drawn

    static void SetUpTestSuite() {
        splitScreen();
        Windows::SetUpTestSuite();
    }

    QRect area(const char* name) const {
        for (const QScreen* screen : QGuiApplication::screens())
            if (screen->name() == name) return screen->geometry();
        return {};
    }
    void tryOut() {
        click("page-studies");
        click("study-peg_in_hole");
        click("watch");
        waitFor([&] { return app_->participant()->isExposed(); });
        waitFor<state::Running>();
    }
    void expectOn(const char* name) {
        EXPECT_EQ(app_->participant()->geometry(), area(name)) << "not on " << name;
        EXPECT_FALSE(app_->participant()->geometry().intersects(app_->experimenter()->geometry()))
            << "it covers the console";
    }
    void endSession() {
        activate(app_->experimenter());
        click("abort");
        click("abort");  // really
        waitFor<state::Incomplete>();
    }
};

TEST_F(Screens, TheParticipantsWindowFillsTheScreenThatTheConsoleIsNotOn) {
    // Truth: invariant. Real windows on monitors of one X server; the console goes from one to another.
    ASSERT_EQ(QGuiApplication::screens().size(), 3);
    ASSERT_EQ(area("RIGHT"), QRect(1600, 0, 1280, 720));
    app_->experimenter()->setPosition(30, 30);
    waitFor([&] { return area("LEFT").contains(app_->experimenter()->geometry()); });
    tryOut();
    expectOn("RIGHT");
    QQuickItem* choice = item(app_->experimenter(), "participantScreen");
    ASSERT_NE(choice, nullptr);
    EXPECT_EQ(choice->property("currentText").toString(), "RIGHT") << "the console's own is not offered";
    picture(app_->experimenter(), "two_screens");
    endSession();
    app_->experimenter()->setGeometry(QRect(1600, 20, 1200, 700));
    waitFor([&] { return app_->experimenter()->position().x() == 1600; });
    tryOut();
    expectOn("LEFT");
    EXPECT_EQ(choice->property("currentText").toString(), "LEFT");
    endSession();
}

TEST_F(Screens, AWindowThatIsOpenedAgainComesBackToItsScreen) {
    // Truth: invariant.
    app_->experimenter()->setPosition(30, 30);
    waitFor([&] { return area("LEFT").contains(app_->experimenter()->geometry()); });
    tryOut();
    expectOn("RIGHT");
    app_->participant()->close();
    waitFor<state::Paused>();
    click("openDisplay");
    waitFor([&] { return app_->participant()->isExposed(); });
    expectOn("RIGHT");
    endSession();
}

TEST_F(Screens, TheScreenThatSomebodyChoseIsRemembered) {
    // Truth: invariant: the next start of the program shows the participant's window there.
    const auto choose = [&](const char* name) {
        QObject* choice = qmlContext(item(app_->experimenter(), "participantScreen"))
                              ->contextProperty("screenChoice")
                              .value<QObject*>();
        choice->setProperty("chosen", choice->property("names").toStringList().indexOf(name));
    };
    app_->experimenter()->setPosition(30, 30);
    waitFor([&] { return area("LEFT").contains(app_->experimenter()->geometry()); });
    tryOut();
    expectOn("RIGHT");
    choose("LOW");
    expectOn("LOW");
    endSession();
    open("en", true);
    app_->experimenter()->setPosition(30, 30);
    waitFor([&] { return area("LEFT").contains(app_->experimenter()->geometry()); });
    tryOut();
    expectOn("LOW");
    EXPECT_EQ(item(app_->experimenter(), "participantScreen")->property("currentText").toString(), "LOW");
    choose("RIGHT");
    endSession();
}

TEST(Places, TheParticipantGetsAScreenThatTheMiddleOfTheConsoleIsNotOn) {
    // Truth: closed form.
    const window::ScreenArea left{"L", QRect(0, 0, 1920, 1080)}, right{"R", QRect(1920, 0, 1280, 1024)};
    EXPECT_EQ(window::participantScreen({left, right}, QRect(100, 100, 800, 600), ""), 1);
    EXPECT_EQ(window::participantScreen({left, right}, QRect(2000, 0, 800, 600), ""), 0);
    EXPECT_EQ(window::participantScreen({left, right}, QRect(1800, 0, 800, 600), ""), 0);
}

TEST(Places, OfThreeScreensTheChosenOneIsTheParticipants) {
    // Truth: closed form. A choice holds until the console is there, or the screen is gone.
    const window::ScreenArea a{"A", QRect(0, 0, 1920, 1080)}, b{"B", QRect(1920, 0, 1280, 1024)},
        c{"C", QRect(3200, 0, 1280, 1024)};
    const QRect on_a(100, 100, 800, 600), on_c(3300, 0, 800, 600);
    EXPECT_EQ(window::participantScreen({a, b, c}, on_a, "C"), 2);
    EXPECT_EQ(window::participantScreen({a, b, c}, on_a, ""), 1);
    EXPECT_EQ(window::participantScreen({a, b, c}, on_c, "C"), 0);
    EXPECT_EQ(window::participantScreen({a, b}, on_a, "C"), 1);
    EXPECT_EQ(window::participantScreen({a}, on_a, "A"), std::nullopt);
}

TEST(Places, AWindowFitsItsScreen) {
    // Truth: closed form. What fits stays; 32 pixels are left for a title bar.
    const QRect small(0, 0, 1280, 720), second(1280, 100, 1366, 768);
    EXPECT_EQ(window::fitting({10, 0, 1000, 600}, small), QRect(10, 0, 1000, 600));
    EXPECT_EQ(window::fitting({0, 0, 1440, 900}, small), QRect(0, 32, 1280, 688));
    EXPECT_EQ(window::fitting({500, 300, 1000, 600}, small), QRect(280, 120, 1000, 600));
    EXPECT_EQ(window::fitting({0, 0, 1440, 900}, second), QRect(1280, 132, 1366, 736));
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
