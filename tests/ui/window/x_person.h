#pragma once

#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <vector>

namespace passung::test {

/// Somebody at the X server's keyboard and mouse, whom no window of ours can hold up; and a window of another program.
class XPerson {
public:
    XPerson() : connection_(xcb_connect(nullptr, nullptr)) {
        if (xcb_connection_has_error(connection_) != 0) throw std::runtime_error("no X server");
        root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
    }
    ~XPerson() { xcb_disconnect(connection_); }
    XPerson(const XPerson&) = delete;
    XPerson& operator=(const XPerson&) = delete;

    void pressEscape() {
        const std::uint8_t key = keyOf(0xff1b);
        fake(XCB_KEY_PRESS, key);
        fake(XCB_KEY_RELEASE, key);
        settle();
    }
    void point(int x, int y) {
        xcb_test_fake_input(connection_, XCB_MOTION_NOTIFY, 0, 0, root_, static_cast<std::int16_t>(x),
                            static_cast<std::int16_t>(y), 0);
        settle();
    }
    void press() {
        fake(XCB_BUTTON_PRESS, 1);
        settle();
    }
    void release() {
        fake(XCB_BUTTON_RELEASE, 1);
        settle();
    }
    void click(int x, int y) {
        point(x, y);
        press();
        release();
    }

    /// Lies above whatever was there; gets the keyboard.
    void openWindow(int x, int y, int width, int height) {
        window_ = xcb_generate_id(connection_);
        xcb_create_window(connection_, XCB_COPY_FROM_PARENT, window_, root_, static_cast<std::int16_t>(x),
                          static_cast<std::int16_t>(y), static_cast<std::uint16_t>(width),
                          static_cast<std::uint16_t>(height), 0, XCB_WINDOW_CLASS_INPUT_OUTPUT, XCB_COPY_FROM_PARENT, 0,
                          nullptr);
        xcb_map_window(connection_, window_);
        settle();
        giveKeyboard(window_);
    }
    void closeWindow() {
        xcb_destroy_window(connection_, window_);
        settle();
    }
    void giveKeyboard(std::uint32_t window) {
        xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_PARENT, window, XCB_CURRENT_TIME);
        settle();
    }

private:
    std::uint8_t keyOf(std::uint32_t symbol) {
        const xcb_setup_t& setup = *xcb_get_setup(connection_);
        const auto count = static_cast<std::uint8_t>(setup.max_keycode - setup.min_keycode + 1);
        const std::unique_ptr<xcb_get_keyboard_mapping_reply_t, decltype(&std::free)> mapping(
            xcb_get_keyboard_mapping_reply(connection_, xcb_get_keyboard_mapping(connection_, setup.min_keycode, count),
                                           nullptr),
            &std::free);
        const xcb_keysym_t* symbols = xcb_get_keyboard_mapping_keysyms(mapping.get());
        for (int key = 0; key < count; ++key)
            if (symbols[key * mapping->keysyms_per_keycode] == symbol)
                return static_cast<std::uint8_t>(setup.min_keycode + key);
        throw std::runtime_error("the keyboard has no such key");
    }
    void fake(std::uint8_t type, std::uint8_t what) {
        xcb_test_fake_input(connection_, type, what, XCB_CURRENT_TIME, root_, 0, 0, 0);
    }
    /// Until the server has done all that.
    void settle() { std::free(xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr)); }

    xcb_connection_t* connection_;
    xcb_window_t root_ = 0, window_ = 0;
};

}  // namespace passung::test
