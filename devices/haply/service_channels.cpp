#include "devices/haply/service_channels.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>

namespace passung::haply {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using std::chrono::milliseconds;
using Tcp = asio::ip::tcp;

constexpr std::size_t kLongestMessage = 1u << 20;

}  // namespace

struct ServiceChannels::Streams {
    /// One WebSocket whose next message is always being read.
    struct WebSocket {
        explicit WebSocket(asio::io_context& context) : stream(context) {}

        beast::websocket::stream<Tcp::socket> stream;
        beast::flat_buffer buffer;
        std::deque<std::string> heard;
        bool open = false;

        void connect(const std::string& host, const Tcp::resolver::results_type& at) {
            asio::async_connect(stream.next_layer(), at, [this, host](error_code wrong, const Tcp::endpoint&) {
                if (wrong) return;
                stream.next_layer().set_option(Tcp::no_delay(true));
                stream.read_message_max(kLongestMessage);
                stream.async_handshake(host, "/", [this](error_code refused) {
                    open = !refused;
                    if (open) read();
                });
            });
        }

        void read() {
            stream.async_read(buffer, [this](error_code wrong, std::size_t) {
                if (wrong) {
                    open = false;
                    return;
                }
                heard.push_back(beast::buffers_to_string(buffer.data()));
                buffer.clear();
                read();
            });
        }

        std::optional<std::string> take() {
            if (heard.empty()) return std::nullopt;
            std::string first = std::move(heard.front());
            heard.pop_front();
            return first;
        }
    };

    asio::io_context context;
    WebSocket simulation{context}, events{context};

    /// Lets things happen until `done`, for so long at most.
    template <class DoneFunction>
    void letRun(milliseconds longest, DoneFunction done) {
        const auto until = std::chrono::steady_clock::now() + longest;
        context.restart();
        context.poll();
        while (!done() && context.run_one_until(until) > 0) {
        }
    }
};

ServiceChannels::ServiceChannels() : streams_(std::make_unique<Streams>()) {}
ServiceChannels::~ServiceChannels() {
    error_code ignored;
    streams_->simulation.stream.next_layer().close(ignored);
    streams_->events.stream.next_layer().close(ignored);
    streams_->context.restart();
    streams_->context.poll();  // what was begun ends before what it uses
}

Result<Done> ServiceChannels::connect(const std::string& host, const std::string& port, const std::string& event_port) {
    Tcp::resolver resolver(streams_->context);
    error_code wrong;
    const auto at = resolver.resolve(host, port, wrong);
    if (wrong) return Error{.message = "no such address: " + host + ":" + port};
    streams_->simulation.connect(host, at);
    const auto events_at = resolver.resolve(host, event_port, wrong);
    if (!wrong) streams_->events.connect(host, events_at);
    streams_->letRun(kConnectTime, [this] { return streams_->simulation.open && streams_->events.open; });
    if (streams_->simulation.open) return Done{};
    return Error{.message = "Haply's Inverse Service does not run: nobody speaks WebSocket at " + host + ":" + port +
                            "; install it from docs.haply.co and `systemctl start haply-inverse-service`"};
}

bool ServiceChannels::send(const std::string& message, milliseconds longest) {
    Streams::WebSocket& simulation = streams_->simulation;
    if (!simulation.open) return false;
    auto sent = std::make_shared<std::pair<std::string, bool>>(message, false);  // outlives a call that gives up
    simulation.stream.text(true);
    simulation.stream.async_write(asio::buffer(sent->first), [sent, &simulation](error_code wrong, std::size_t) {
        sent->second = true;
        if (wrong) simulation.open = false;
    });
    streams_->letRun(longest, [&] { return sent->second; });
    if (!sent->second) simulation.open = false;  // it takes nothing any more
    return simulation.open;
}

std::optional<std::string> ServiceChannels::message(milliseconds longest) {
    Streams::WebSocket& simulation = streams_->simulation;
    streams_->letRun(longest, [&] { return !simulation.heard.empty() || !simulation.open; });
    return simulation.take();
}

std::optional<std::string> ServiceChannels::event() { return streams_->events.take(); }
bool ServiceChannels::hears() const { return streams_->events.open; }
bool ServiceChannels::isOpen() const { return streams_->simulation.open; }

}  // namespace passung::haply
