// mote view: a scene, or pictures, in the browser.
#include <spawn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "apps/command.h"
#include "apps/subcommands.h"
#include "apps/view_comparison.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/output_files.h"
#include "viewer/server.h"
#include "viewer/view.h"
#include "viewer/wish_changes.h"

namespace mote::apps {

namespace {

/// Joins the server to the view.
class Clients final : public viewer::ServerEvents {
  public:
    explicit Clients(viewer::View& view) : view_(view) {}
    void left(int client) override { view_.leave(client); }
    void received(int client, std::string_view text) override { view_.receive(client, text); }

  private:
    viewer::View& view_;
};

/// Where there is a display, and a program that opens addresses.
void open_browser(const std::string& url) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
    std::string program = "xdg-open", address = url;
    char* arguments[] = {program.data(), address.data(), nullptr};
    pid_t child = 0;
    ::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ);
}

bool is_picture(const std::string& path) { return extension_of(path) == ".exr"; }

void show(viewer::View& view, const ViewArguments& a) {
    for (const std::string& path : a.files)
        if (is_picture(path) != is_picture(a.files.front()))
            throw UsageError("a view is of one scene, or of pictures (.exr)");
    if (!a.reference.empty()) view.set_reference(a.reference, core::read_exr(a.reference));
    if (is_picture(a.files.front())) {
        for (const std::string& path : a.files) view.show_picture(path, core::read_exr(path));
        return;
    }
    if (a.files.size() > 1) throw UsageError("a view is of one scene, or of pictures (.exr)");
    viewer::ViewSettings settings{scene_changes(a.scene), a.seed, a.passes, a.threads};
    // Changes to the integrator are made to the scene that is loaded.
    const LoadedScene scene =
        LoadedScene::from_file(a.files.front(), viewer::outside_integrator(settings.changes));
    warn_about(scene);
    view.show_scene(scene, settings);
}

}  // namespace

int view_command(const ViewArguments& arguments) {
    viewer::ServerSettings settings;
    settings.port = arguments.port, settings.token = arguments.token;
    if (!arguments.bind.empty()) {
        if (arguments.token.size() < 16)
            throw UsageError(
                "--bind opens the view to other machines: it needs a --token of 16 letters or more");
        settings.address = arguments.bind;
    }
    viewer::Server server(settings);
    viewer::View view(
        [&server](int client, const viewer::SharedMessage& message) { server.send(client, message); },
        std::make_unique<TradePage>());
    show(view, arguments);
    Clients clients(view);
    server.start(clients);
    std::printf("%s\n", server.url().c_str());
    std::fflush(stdout);
    if (!arguments.no_browser) open_browser(server.url());
    for (;;) ::pause();  // Ctrl-C ends the program: there is nothing to lose
}

}  // namespace mote::apps
