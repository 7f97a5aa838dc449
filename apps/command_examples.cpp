// Examples of each command.
#include <map>

#include "apps/manual_command.h"

namespace mote::apps {

namespace {

const std::map<std::string, std::string> examples = {
    {"render",
     "  mote render scene.xml -o out/scene.exr --time 60\n"
     "  mote render scene.xml -o out/scene.exr --noise 0.02 --integrator volpath -D film.width=640\n"
     "  mote render scene.xml -o frames/####.exr -D t=0:47"},
    {"plan", "  mote plan scene.xml\n  mote plan scene.xml --integrator mote_vpl -D integrator.paths=1024"},
    {"info", "  mote info out/scene.exr\n  mote info smoke.vdb"},
    {"convert",
     "  mote convert out/scene.exr brighter.png --exposure 1 --tone filmic\n"
     "  mote convert out/scene.exr indirect.png --layer indirect\n"
     "  mote convert frames/####.exr film.mp4 --rate 30"},
    {"trade",
     "  mote trade scene.xml -o out/trade --time 30\n"
     "  mote trade scene.xml -o out/trade --methods methods.json --reference out/reference.exr"},
    {"merge", "  mote merge a.film b.film c.film -o out/scene.exr"},
    {"compare",
     "  mote compare out/scene.exr out/reference.exr\n"
     "  mote compare out/scene.exr out/reference.exr --difference x4 -o difference.png"},
    {"denoise", "  mote denoise out/scene.exr -o out/denoised.exr"},
    {"ssbc", "  mote ssbc out/bounded.exr -o out/compensated.exr"},
    {"export", "  mote export scene.xml --to mitsuba3 -o out/mitsuba"},
    {"view", "  mote view scene.xml\n  mote view out/a.exr out/b.exr --reference out/reference.exr"},
    {"formats", "  mote formats > scene-format.md"},
    {"manual", "  mote manual ~/.local/share"},
};

}  // namespace

void add_examples(CLI::App& app) {
    for (CLI::App* command : app.get_subcommands({}))
        if (const auto found = examples.find(command->get_name()); found != examples.end())
            command->footer("Examples:\n" + found->second);
}

}  // namespace mote::apps
