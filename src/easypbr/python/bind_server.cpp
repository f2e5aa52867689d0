// Server, as the Python class of the same name uses it.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "easypbr/app/widgets.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/python/held.h"
#include "easypbr/python/shared_viewer.h"
#include "easypbr/python/text.h"
#include "easypbr/remote/page.h"
#include "easypbr/remote/server.h"
#include "easypbr/scene/animation.h"

namespace easypbr::python {
namespace {

using remote::Channel;
using remote::Server;
using remote::ServerClient;

std::shared_ptr<Server> serve(SharedViewer& self, int port, const std::string& bind, const fs::path& socket,
                              const fs::path& token_file, const std::vector<std::string>& host_names,
                              const std::vector<std::string>& origins, int max_clients,
                              const std::string& codec, int own_views, bool own_views_for_watchers,
                              const fs::path& files) {
    const remote::ServeOptions options{
        .port = port,
        .bind = bind,
        .socket = socket,
        .token_file = token_file,
        .host_names = host_names,
        .origins = origins,
        .max_clients = max_clients,
        .codec = codec,
        .own_views = own_views,
        .own_views_for_watchers = own_views_for_watchers,
        .files = files,
    };
    return self.run([&](Viewer& viewer) { return viewer.serve(options); });
}

/// `function` takes the widgets and returns a traceback, or None. It is called on the server's thread.
template <class Front>
void add_front_panel(Front& self, const std::string& name, nb::object function) {
    const auto panel = [function = held(std::move(function))](app::Widgets& widgets) {
        std::string failure;
        {
            const nb::gil_scoped_acquire gil;
            try {
                const nb::object told = (*function)(nb::cast(&widgets, nb::rv_policy::reference));
                if (!told.is_none()) failure = nb::cast<std::string>(told);
            } catch (const std::exception& error) {
                failure = error.what();
            }
        }
        if (!failure.empty()) throw Error(failure);
    };
    released([&] { self.add_panel(name, panel); });
}

template <class Front>
void remove_front_panel(Front& self, const std::string& name) {
    released([&] { self.remove_panel(name); });
}

/// Client, words, bytes and code of each message.
using Messages = std::vector<std::tuple<uint64_t, std::string, nb::bytes, int>>;

Messages take(Channel& self, double seconds) {
    const auto messages = released([&] { return self.take(seconds); });
    Messages taken;
    for (const remote::ChannelMessage& message : messages)
        taken.emplace_back(message.client, message.text,
                           nb::bytes(message.bytes.data(), message.bytes.size()), message.close_code);
    return taken;
}

void bind_channel(nb::module_& module, nb::class_<SharedViewer>& viewer) {
    nb::class_<Channel>(module, "ChannelHandle", "A view for clients whose messages Python carries.")
        .def("receive", [](Channel& self, uint64_t client,
                           const std::string& text) { released([&] { self.receive(client, text); }); })
        .def("leave", [](Channel& self, uint64_t client) { released([&] { self.leave(client); }); })
        .def("take", take, nb::arg("seconds"))
        .def("client_count", &Channel::client_count)
        .def_prop_ro("is_open", &Channel::is_open)
        .def("add_animations",
             [](Channel& self, const std::string& name, const Animations& animations) {
                 released([&] { self.add_animations(name, animations); });
             })
        .def("add_panel", add_front_panel<Channel>)
        .def("remove_panel", remove_front_panel<Channel>)
        .def("close", [](Channel& self) { released([&] { self.close(); }); });
    viewer.def("open_channel",
               [](SharedViewer& self) { return self.run([](Viewer& view) { return view.open_channel(); }); });
    module.def("widget_script", [] { return std::string(remote::offline_document("widget.js")); });
}

}  // namespace

void bind_server(nb::module_& module, nb::class_<SharedViewer>& viewer) {
    nb::class_<ServerClient>(module, "ServerClient", "A browser that looks at a served view.")
        .def_ro("id", &ServerClient::id, "Number of the connection.")
        .def_ro("controls", &ServerClient::controls,
                "Whether it moves the camera, the shared one or its own.")
        .def_ro("watches_only", &ServerClient::watches_only, "Whether it came by watch_url.")
        .def_ro("has_own", &ServerClient::has_own, "Whether it looks through a camera of its own.")
        .def_ro("latency_s", &ServerClient::latency_s,
                "Seconds from sending an image to its being drawn; 0 before the first.")
        .def("__repr__", [](const ServerClient& client) {
            return "<ServerClient " + std::to_string(client.id) + (client.controls ? ", controls>" : ">");
        });
    nb::class_<Server>(module, "ServerHandle", "A view in the browsers of other machines.")
        .def_prop_ro("url", &Server::url)
        .def_prop_ro("watch_url", &Server::watch_url)
        .def_prop_ro("urls", &Server::urls)
        .def_prop_ro("port", &Server::port)
        .def_prop_ro("is_open", &Server::is_open)
        .def("forward_command", &Server::forward_command, nb::arg("host"))
        .def("clients", [](const Server& self) { return released([&] { return self.clients(); }); })
        .def("add_animations",
             [](Server& self, const std::string& name, const Animations& animations) {
                 released([&] { self.add_animations(name, animations); });
             })
        .def("add_panel", add_front_panel<Server>)
        .def("remove_panel", remove_front_panel<Server>)
        .def("close", [](Server& self) { released([&] { self.close(); }); });
    viewer.def("serve", serve, nb::arg("port"), nb::arg("bind"), nb::arg("socket"), nb::arg("token_file"),
               nb::arg("host_names"), nb::arg("origins"), nb::arg("max_clients"), nb::arg("codec"),
               nb::arg("own_views"), nb::arg("own_views_for_watchers"), nb::arg("files"));
    bind_channel(module, viewer);
}

}  // namespace easypbr::python
