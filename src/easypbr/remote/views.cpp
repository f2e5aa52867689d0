#include "easypbr/remote/views.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "easypbr/app/history.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/core/log.h"
#include "easypbr/core/start_thread.h"
#include "easypbr/remote/served_files.h"
#include "easypbr/scene/animation.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {

Views::Views(const Scene& scene, const Settings& settings, Inbox& inbox, Clients& clients,
             std::unique_ptr<ServedFiles> files)
    : inbox_(inbox),
      clients_(clients),
      shared_(scene, settings, inbox, {clients, shared_view}, std::move(files)),
      given_(std::make_shared<const Settings>(settings)) {}

Views::~Views() {
    stop();
}

void Views::start() {
    thread_ = started([this] { return std::thread([this] { run(); }); });
    ::pthread_setname_np(thread_.native_handle(), "easypbr view");
}

void Views::stop() {
    inbox_.close();
    if (draws_here()) return;
    if (thread_.joinable()) thread_.join();
    // The program's functions may hold what holds the views.
    inbox_.take_tasks();
    own_.clear();
    shared_.end();
}

bool Views::draws_here() const {
    return drawing_ == std::this_thread::get_id();
}

void Views::run() {
    drawing_ = std::this_thread::get_id();
    // What is drawn when the server ends is given up.
    const InterruptScope scope([this] { return inbox_.is_closed(); });
    while (!inbox_.is_closed()) turn();
    drawing_ = std::thread::id();
}

void Views::turn() {
    for (const auto& task : inbox_.take_tasks()) try {
            task();
        } catch (const std::exception& error) {
            log_warning(std::string("served view: ") + error.what());
        }
    follow_clients();
    if (!clients_.anybody()) return inbox_.wait(60);
    const View* const refined = refined_next();
    double wait = stepped(shared_, &shared_ == refined);
    for (const auto& [id, view] : own_) wait = std::min(wait, stepped(*view, view.get() == refined));
    if (wait > 0) inbox_.wait(wait);
}

double Views::stepped(View& view, bool refines) try {
    return view.step(refines);
} catch (const Interrupted&) {
    return 0;
} catch (const std::exception& error) {
    log_warning(std::string("served view: ") + error.what());
    return 1;
}

void Views::follow_clients() {
    const std::vector<OwnViewOf> wanted = clients_.own_views();
    std::erase_if(own_, [&](const auto& each) {
        const bool ended = std::ranges::find(wanted, each.first, &OwnViewOf::id) == wanted.end();
        if (ended) inbox_.take(each.first);
        return ended;
    });
    for (const OwnViewOf& view : wanted)
        if (!own_.contains(view.id))
            own_[view.id] = std::make_unique<View>(shared_, inbox_, ViewClients(clients_, view.id), view);
}

const View* Views::refined_next() {
    std::vector<std::pair<ViewId, const View*>> views = {{shared_view, &shared_}};
    for (const auto& [id, view] : own_) views.emplace_back(id, view.get());
    if (std::ranges::any_of(views, [](const auto& each) { return each.second->is_quick(); })) return nullptr;
    // The last one until it is complete, then the next in turn.
    std::stable_partition(views.begin(), views.end(),
                          [&](const auto& each) { return each.first >= refined_; });
    for (const auto& [id, view] : views)
        if (view->wants_refinement()) {
            refined_ = id;
            return view;
        }
    return &shared_;
}

void Views::take_settings(const Settings& settings) {
    const std::lock_guard lock(giving_);
    // A program that only reads its settings does not wake the thread.
    if (!waits_ && app::same_choices(*given_, settings)) return;
    given_ = std::make_shared<const Settings>(settings);
    if (!std::exchange(waits_, true)) inbox_.add([this] { pass_settings_on(); });
}

void Views::pass_settings_on() {
    std::shared_ptr<const Settings> given;
    {
        const std::lock_guard lock(giving_);
        waits_ = false;
        given = given_;
    }
    shared_.take_settings(*given);
    for (const auto& [id, view] : own_) view->take_settings(*given);
}

void Views::add_animations(const std::string& name, const Animations& animations) {
    inbox_.add([this, name, animations] { shared_.add_animations(name, animations); });
}

void Views::add_panel(const std::string& name, app::PanelFunction function) {
    app::UserPanels().add(name, function);  // What is wrong is told here.
    inbox_.add([this, name, function = std::move(function)] { shared_.add_panel(name, function); });
}

void Views::remove_panel(const std::string& name) {
    inbox_.add([this, name] { shared_.remove_panel(name); });
}

}  // namespace easypbr::remote
