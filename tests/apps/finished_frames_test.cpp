// Frames of a sequence that --resume takes for finished: those of the same scene, seed and passes, and no
// others. Each is changed alone.
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;

namespace {

using Values = std::vector<std::string>;

struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0"><default name="t" value="0"/>
            <default name="colour" value="1, 1, 1"/><integrator type="path"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="6"/>
            <integer name="height" value="4"/></film></sensor>
            <shape type="sphere"><transform name="to_world"><translate x="$t" z="-3"/></transform></shape>
            <emitter type="constant"><rgb name="radiance" value="$colour"/></emitter></scene>)");
    }
    /// How many of the two frames were taken for finished.
    int finished(const Values& more) const {
        Values all = {"render", "scene.xml", "-t", "1", "-D", "t=3:4", "-o", "f.##.exr", "--resume"};
        all.insert(all.end(), more.begin(), more.end());
        const RunResult run = run_mote(*this, all);
        INFO(run.err);
        CHECK(run.exit_code == 0);
        int count = 0;
        for (auto at = run.err.find("is finished"); at != std::string::npos; ++count)
            at = run.err.find("is finished", at + 1);
        return count;
    }
    std::string metadata(const std::string& key) const {
        return core::read_exr(file("f.04.exr")).metadata.at(key);
    }
};

}  // namespace

TEST_CASE("a frame is finished where scene, seed and passes are the same", "[sequence][conjunctions]") {
    const Folder folder;
    const Values first = {"--passes", "2", "--seed", "7", "-D", "colour=1,0.5,0.2"};
    CHECK(folder.finished(first) == 0);
    CHECK(folder.finished(first) == 2);
    CHECK(folder.metadata("seed") == "11");  // and the number of the frame

    CHECK(folder.finished({"--passes", "2", "--seed", "8", "-D", "colour=1,0.5,0.2"}) == 0);
    CHECK(folder.metadata("seed") == "12");
    CHECK(folder.finished({"--passes", "3", "--seed", "8", "-D", "colour=1,0.5,0.2"}) == 0);
    CHECK(folder.metadata("passes") == "3");
    CHECK(folder.finished({"--passes", "3", "--seed", "8", "-D", "colour=1,0.5,0.3"}) == 0);
    CHECK(folder.finished({"--passes", "3", "--seed", "8", "-D", "colour=1,0.5,0.3"}) == 2);
}
