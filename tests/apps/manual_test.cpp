// Man pages and completions: what `mote manual` writes names every option, and bash completes with it.
#include <filesystem>
#include <regex>

#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

/// Completions by bash of the last of these words.
std::string completed(const TemporaryFolder& folder, const std::string& words) {
    const std::string script =
        "source " + folder.file("bash-completion/completions/mote") + "; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _mote; echo \"${COMPREPLY[@]}\" > " + folder.file("words");
    REQUIRE(std::system(("bash -c '" + script + "'").c_str()) == 0);
    return read_file(folder.file("words"));
}

}  // namespace

TEST_CASE("Man pages and completions hold every option of every command", "[command][manual]") {
    const TemporaryFolder folder;
    REQUIRE(run_mote(folder, {"manual", folder.path()}).exit_code == 0);
    int pages = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("man/man1"))) {
        const std::string name = entry.path().stem().string(), page = read_file(entry.path().string());
        if (name == "mote") continue;
        ++pages;
        const std::string command = name.substr(5), help = run_mote(folder, {command, "--help"}).out;
        INFO(command);
        CHECK(page.find(".SH EXAMPLES") != std::string::npos);
        CHECK(help.find("Examples:") != std::string::npos);
        // Every option of the help, and of the examples below it.
        const std::string all = completed(folder, "mote " + command + " --");
        const auto check = [&](const std::string& text, const std::regex& option) {
            for (auto i = std::sregex_iterator(text.begin(), text.end(), option); i != std::sregex_iterator();
                 ++i) {
                INFO(i->str(1));
                CHECK((" " + all).find(" " + i->str(1)) != std::string::npos);
            }
        };
        check(help, std::regex("\n  (?:[A-Z]+,)?(?:-\\w,)?(--[a-z][a-z-]+)"));
        check(help.substr(help.find("Examples:")), std::regex(" (--[a-z][a-z-]+)"));
    }
    CHECK(pages >= 13);
    CHECK(completed(folder, "mote ren") == "render\n");
    CHECK(completed(folder, "mote render --pas") == "--passes --pass-range\n");
    CHECK(completed(folder, "mote export --to m") == "mitsuba3\n");
    CHECK(completed(folder, "mote plan --passes").find("--passes") == std::string::npos);
}
