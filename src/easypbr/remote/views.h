// Views: the thread that draws what clients see.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "easypbr/remote/view.h"

namespace easypbr::remote {

/// The shared view, and those of clients' own as Clients says. All draw by one device, one after another:
/// one picture at rest is drawn to its end before the next, and none while another view moves.
class Views {
  public:
    /// `inbox` and `clients` must outlive it. Who controls the shared view may open `files`; null: none.
    Views(const Scene& scene, const Settings& settings, Inbox& inbox, Clients& clients,
          std::unique_ptr<ServedFiles> files = nullptr);
    /// Gives up what is drawn.
    ~Views();
    Views(const Views&) = delete;
    Views& operator=(const Views&) = delete;

    void start();
    /// Ends the thread. Nothing is published afterwards. On the thread itself, which a panel's function runs
    /// on, it only has it end after that function: a later call waits for the end.
    void stop();
    /// Whether the caller runs on the thread.
    bool draws_here() const;

    /// Any thread: what the program has changed since the last call is changed in all views; what clients
    /// have changed stays.
    void take_settings(const Settings& settings);
    /// Any thread. Who controls the shared view plays them.
    void add_animations(const std::string& name, const Animations& animations);
    /// Any thread; the function is called on the views'. Panels belong to the shared view.
    void add_panel(const std::string& name, app::PanelFunction function);
    void remove_panel(const std::string& name);

  private:
    void run();
    void turn();
    void pass_settings_on();
    /// Begins and ends views as clients want.
    void follow_clients();
    /// Which of them goes on with its picture; null: none.
    const View* refined_next();
    static double stepped(View& view, bool refines);

    Inbox& inbox_;
    Clients& clients_;
    View shared_;
    std::map<ViewId, std::unique_ptr<View>> own_;
    ViewId refined_ = shared_view;
    std::thread thread_;
    std::atomic<std::thread::id> drawing_;  ///< that of run()

    std::mutex giving_;                      ///< of the two below
    std::shared_ptr<const Settings> given_;  ///< of the program, the newest
    bool waits_ = false;                     ///< they wait for the thread, which has the newest alone
};

}  // namespace easypbr::remote
