#include "easypbr/gui/clipboard.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <xcb/xcb.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <thread>

#include "easypbr/core/error.h"

namespace easypbr::gui {
namespace {

#define EASYPBR_XCB_FUNCTIONS(X)                                                                         \
    X(xcb_connect)                                                                                       \
    X(xcb_connection_has_error)                                                                          \
    X(xcb_disconnect)                                                                                    \
    X(xcb_get_setup)                                                                                     \
    X(xcb_setup_roots_iterator)                                                                          \
    X(xcb_generate_id) X(xcb_create_window) X(xcb_intern_atom) X(xcb_intern_atom_reply)                  \
        X(xcb_convert_selection) X(xcb_get_property) X(xcb_get_property_reply) X(xcb_get_property_value) \
            X(xcb_get_property_value_length) X(xcb_poll_for_event) X(xcb_flush)

/// libxcb, which Xlib is made of and which is therefore there wherever a window is.
struct Xcb {
#define EASYPBR_DECLARE(name) decltype(&::name) name = nullptr;
    EASYPBR_XCB_FUNCTIONS(EASYPBR_DECLARE)
#undef EASYPBR_DECLARE
};

Xcb load_xcb() {
    void* library = dlopen("libxcb.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw ContextError(fmt::format("no clipboard: libxcb.so.1 cannot be loaded ({})", dlerror()));
    Xcb functions;
#define EASYPBR_LOAD(name)                                                              \
    functions.name = reinterpret_cast<decltype(functions.name)>(dlsym(library, #name)); \
    if (!functions.name) throw ContextError("no clipboard: libxcb.so.1 has no function " #name);
    EASYPBR_XCB_FUNCTIONS(EASYPBR_LOAD)
#undef EASYPBR_LOAD
    return functions;
}

/// What xcb allocates.
template <class T>
using Reply = std::unique_ptr<T, decltype(&std::free)>;

template <class T>
Reply<T> owned(T* reply) {
    return {reply, &std::free};
}

/// A connection with an invisible window that answers go to.
class Reader {
  public:
    Reader(const Xcb& xcb, const char* display) : xcb_(xcb), connection_(xcb.xcb_connect(display, nullptr)) {
        if (xcb_.xcb_connection_has_error(connection_)) {
            xcb_.xcb_disconnect(connection_);
            throw ContextError(fmt::format("no clipboard: the display {} cannot be reached", display));
        }
        window_ = xcb_.xcb_generate_id(connection_);
        const xcb_screen_t* screen = xcb_.xcb_setup_roots_iterator(xcb_.xcb_get_setup(connection_)).data;
        xcb_.xcb_create_window(connection_, XCB_COPY_FROM_PARENT, window_, screen->root, 0, 0, 1, 1, 0,
                               XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
    }
    ~Reader() { xcb_.xcb_disconnect(connection_); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    void ask() {
        text_ = atom("UTF8_STRING");
        answer_ = atom("EASYPBR_CLIPBOARD");
        xcb_.xcb_convert_selection(connection_, window_, atom("CLIPBOARD"), text_, answer_, XCB_CURRENT_TIME);
        xcb_.xcb_flush(connection_);
    }

    /// The owner, or the server in place of one that there is not, has answered.
    bool has_answer() {
        while (const auto event = owned(xcb_.xcb_poll_for_event(connection_))) {
            if ((event->response_type & 0x7f) != XCB_SELECTION_NOTIFY) continue;
            given_ = reinterpret_cast<const xcb_selection_notify_event_t*>(event.get())->property;
            return true;
        }
        if (xcb_.xcb_connection_has_error(connection_))
            throw ContextError("no clipboard: the display has gone away");
        return false;
    }

    std::string text() {
        if (given_ == XCB_ATOM_NONE) return {};
        constexpr uint32_t most_words = 1 << 24;
        const auto property = owned(xcb_.xcb_get_property_reply(
            connection_,
            xcb_.xcb_get_property(connection_, 1, window_, answer_, XCB_GET_PROPERTY_TYPE_ANY, 0, most_words),
            nullptr));
        if (!property || property->type != text_) return {};
        return {static_cast<const char*>(xcb_.xcb_get_property_value(property.get())),
                size_t(xcb_.xcb_get_property_value_length(property.get()))};
    }

  private:
    xcb_atom_t atom(std::string_view name) {
        const auto reply = owned(xcb_.xcb_intern_atom_reply(
            connection_, xcb_.xcb_intern_atom(connection_, 0, uint16_t(name.size()), name.data()), nullptr));
        return reply ? reply->atom : xcb_atom_t(XCB_ATOM_NONE);
    }

    const Xcb& xcb_;
    xcb_connection_t* connection_;
    xcb_window_t window_ = 0;
    xcb_atom_t text_ = 0, answer_ = 0, given_ = 0;
};

}  // namespace

std::string read_clipboard(const char* display, double seconds, const std::function<void()>& serve) {
    static const Xcb xcb = load_xcb();
    Reader reader(xcb, display);
    reader.ask();
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!reader.has_answer()) {
        if (std::chrono::steady_clock::now() > end)
            throw ContextError(
                fmt::format("clipboard: the program that holds it did not answer within {:g} s", seconds));
        serve();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return reader.text();
}

}  // namespace easypbr::gui
