#include "ui/window/stop_listener.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <xcb/xcb.h>
#include <xcb/xinput.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

namespace passung::window {

namespace {

constexpr std::uint32_t kEscape = 0xff1b;      // keysym
constexpr std::uint32_t kLeftButton = 1;       // of a pointer
constexpr std::uint32_t kUnderThePointer = 1;  // in a focus' place: the keyboard follows the pointer
constexpr int kDeepest = 64;                   // windows in windows

template <class T>
using XcbReply = std::unique_ptr<T, decltype(&std::free)>;

template <class T>
XcbReply<T> owned(T* reply) {
    return XcbReply<T>(reply, &std::free);
}

int pixels(xcb_input_fp1616_t fixed) { return static_cast<int>(fixed >> 16); }

/// The X server as the listener asks it. What a window that is gone answers counts as no.
class Server {
public:
    Server() : connection_(xcb_connect(nullptr, nullptr)) {
        if (xcb_connection_has_error(connection_) != 0) return;
        root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
        hears_ = selects();
        learnKeys();
    }
    ~Server() { xcb_disconnect(connection_); }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    bool hears() const { return hears_; }
    bool isLost() const { return xcb_connection_has_error(connection_) != 0; }
    int file() const { return xcb_get_file_descriptor(connection_); }
    XcbReply<xcb_generic_event_t> event() { return owned(xcb_poll_for_event(connection_)); }
    /// The opcode of XInput's events.
    std::uint8_t opcode() const { return xcb_get_extension_data(connection_, &xcb_input_id)->major_opcode; }

    /// Which keys are Esc: layouts change.
    void learnKeys();
    bool isEscape(std::uint32_t key) const {
        return std::find(escapes_.begin(), escapes_.end(), key) != escapes_.end();
    }

    /// Does this keyboard write into one of these windows or into what lies in one?
    bool writesInto(xcb_input_device_id_t keyboard, const std::vector<std::uint32_t>& windows);
    /// Is this pointer on the button?
    bool isOnButton(xcb_input_device_id_t pointer, const StopTargets& targets);

private:
    bool selects();
    /// The windows under the pointer, from the root's child to the innermost.
    std::vector<std::uint32_t> under(xcb_input_device_id_t pointer);

    xcb_connection_t* connection_;
    xcb_window_t root_ = 0;
    bool hears_ = false;
    std::vector<std::uint32_t> escapes_;
};

bool Server::selects() {
    const auto* extension = xcb_get_extension_data(connection_, &xcb_input_id);
    if (extension == nullptr || extension->present == 0) return false;
    const auto version =
        owned(xcb_input_xi_query_version_reply(connection_, xcb_input_xi_query_version(connection_, 2, 2), nullptr));
    if (!version || version->major_version < 2 || (version->major_version == 2 && version->minor_version < 2))
        return false;
    struct {
        xcb_input_event_mask_t head;
        std::uint32_t mask;
    } wanted{{XCB_INPUT_DEVICE_ALL_MASTER, 1},
             XCB_INPUT_XI_EVENT_MASK_RAW_KEY_PRESS | XCB_INPUT_XI_EVENT_MASK_RAW_BUTTON_PRESS};
    const auto cookie = xcb_input_xi_select_events_checked(connection_, root_, 1, &wanted.head);
    return owned(xcb_request_check(connection_, cookie)) == nullptr;
}

void Server::learnKeys() {
    const xcb_setup_t& setup = *xcb_get_setup(connection_);
    const auto count = static_cast<std::uint8_t>(setup.max_keycode - setup.min_keycode + 1);
    const auto mapping = owned(xcb_get_keyboard_mapping_reply(
        connection_, xcb_get_keyboard_mapping(connection_, setup.min_keycode, count), nullptr));
    if (!mapping) return;
    escapes_.clear();
    const xcb_keysym_t* symbols = xcb_get_keyboard_mapping_keysyms(mapping.get());
    const int each = mapping->keysyms_per_keycode;
    for (int key = 0; key < count; ++key)
        if (each > 0 && symbols[key * each] == kEscape)
            escapes_.push_back(static_cast<std::uint32_t>(setup.min_keycode + key));
}

bool Server::writesInto(xcb_input_device_id_t keyboard, const std::vector<std::uint32_t>& windows) {
    const auto isOurs = [&](std::uint32_t window) {
        return std::find(windows.begin(), windows.end(), window) != windows.end();
    };
    const auto focus =
        owned(xcb_input_xi_get_focus_reply(connection_, xcb_input_xi_get_focus(connection_, keyboard), nullptr));
    if (!focus) return false;
    if (focus->focus == kUnderThePointer) {
        const auto pointed = under(XCB_INPUT_DEVICE_ALL);
        return std::any_of(pointed.begin(), pointed.end(), isOurs);
    }
    std::uint32_t window = focus->focus;
    for (int depth = 0; depth < kDeepest && window != 0 && window != root_; ++depth) {
        if (isOurs(window)) return true;
        const auto tree = owned(xcb_query_tree_reply(connection_, xcb_query_tree(connection_, window), nullptr));
        window = tree ? tree->parent : 0;
    }
    return false;
}

std::vector<std::uint32_t> Server::under(xcb_input_device_id_t pointer) {
    std::vector<std::uint32_t> windows;
    std::uint32_t window = root_;
    for (int depth = 0; depth < kDeepest && window != 0; ++depth) {
        if (pointer == XCB_INPUT_DEVICE_ALL) {  // whichever pointer the core protocol calls the pointer
            const auto at =
                owned(xcb_query_pointer_reply(connection_, xcb_query_pointer(connection_, window), nullptr));
            window = at ? at->child : 0;
        } else {
            const auto at = owned(xcb_input_xi_query_pointer_reply(
                connection_, xcb_input_xi_query_pointer(connection_, window, pointer), nullptr));
            window = at ? at->child : 0;
        }
        if (window != 0) windows.push_back(window);
    }
    return windows;
}

bool Server::isOnButton(xcb_input_device_id_t pointer, const StopTargets& targets) {
    if (targets.window == 0) return false;
    const auto isInside = [&] {
        const auto at = owned(xcb_input_xi_query_pointer_reply(
            connection_, xcb_input_xi_query_pointer(connection_, targets.window, pointer), nullptr));
        if (!at) return false;
        const int x = pixels(at->win_x) - targets.left, y = pixels(at->win_y) - targets.top;
        return x >= 0 && y >= 0 && x < targets.width && y < targets.height;
    };
    // The pointer may move between two questions: what it is over counts if it is on the button before and after.
    if (!isInside()) return false;
    const auto pointed = under(pointer);
    return std::find(pointed.begin(), pointed.end(), targets.window) != pointed.end() && isInside();
}

}  // namespace

struct StopListener::Hearing {
    explicit Hearing(std::function<void()> what) : stop(std::move(what)) {}
    ~Hearing() { close(end); }
    Hearing(const Hearing&) = delete;
    Hearing& operator=(const Hearing&) = delete;

    void listen();
    bool means(const xcb_generic_event_t& event);

    Server server;
    std::function<void()> stop;
    int end = eventfd(0, EFD_CLOEXEC);  // can be read: the thread shall end
    std::mutex mutex;                   // of what follows
    StopTargets targets;
    std::thread thread;
};

/// Is this event an emergency stop?
bool StopListener::Hearing::means(const xcb_generic_event_t& event) {
    constexpr std::uint8_t kSent = 0x80;  // marks what another client has sent
    const std::uint8_t type = event.response_type & static_cast<std::uint8_t>(~kSent);
    if (type == XCB_MAPPING_NOTIFY) server.learnKeys();
    if (type != XCB_GE_GENERIC) return false;
    const auto& generic = reinterpret_cast<const xcb_ge_generic_event_t&>(event);
    if (generic.extension != server.opcode()) return false;
    StopTargets wanted;
    {
        const std::lock_guard lock(mutex);
        wanted = targets;
    }
    if (generic.event_type == XCB_INPUT_RAW_KEY_PRESS) {
        const auto& press = reinterpret_cast<const xcb_input_raw_key_press_event_t&>(event);
        return server.isEscape(press.detail) && server.writesInto(press.deviceid, wanted.windows);
    }
    if (generic.event_type == XCB_INPUT_RAW_BUTTON_PRESS) {
        const auto& press = reinterpret_cast<const xcb_input_raw_button_press_event_t&>(event);
        return press.detail == kLeftButton && server.isOnButton(press.deviceid, wanted);
    }
    return false;
}

void StopListener::Hearing::listen() {
    for (;;) {
        while (const auto event = server.event())
            if (means(*event)) stop();
        if (server.isLost()) return;
        pollfd files[] = {{server.file(), POLLIN, 0}, {end, POLLIN, 0}};
        poll(files, std::size(files), -1);
        if (files[1].revents != 0) return;
    }
}

StopListener::StopListener(std::function<void()> stop) {
    auto hearing = std::make_unique<Hearing>(std::move(stop));
    if (!hearing->server.hears()) return;
    hearing_ = std::move(hearing);
    hearing_->thread = std::thread([this] { hearing_->listen(); });
}

StopListener::~StopListener() {
    if (!hearing_) return;
    const std::uint64_t once = 1;
    [[maybe_unused]] const auto written = write(hearing_->end, &once, sizeof once);
    hearing_->thread.join();
}

void StopListener::watch(StopTargets targets) {
    if (!hearing_) return;
    const std::lock_guard lock(hearing_->mutex);
    hearing_->targets = std::move(targets);
}

}  // namespace passung::window
