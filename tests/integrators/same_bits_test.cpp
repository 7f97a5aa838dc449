// One thread or many, in one go or interrupted and resumed, on one machine or two: the same bits, for
// everything that is registered.
//
// The settings are walked through by the manual pages: every integrator with its defaults, then with one
// parameter changed at a time, and with every pair of nested objects (compensation and visibility). Types
// that are registered later take part: values come from the choices and ranges of declared rows.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <charconv>
#include <cmath>
#include <set>

#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/environment.h"
#include "tests/support/integrator_of.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

/// Larger integers are lowered to this one: pictures are quick, and light paths come in more than one chunk.
constexpr std::int64_t largest_integer = 40;

/// Texts for the one parameter that declares neither choices nor a range.
const std::vector<std::string> shares = {"3", "2, 1", "1, 2, 1"};

/// The default, where it is a number.
std::optional<double> default_of(const Parameter& p) {
    double number = 0.0;
    const char* const end = p.default_value.data() + p.default_value.size();
    const auto [read, error] = std::from_chars(p.default_value.data(), end, number);
    return error == std::errc() && read == end ? std::optional(number) : std::nullopt;
}

/// Another number than `usual` that the row allows: the lower end of an integer, or zero, or half of it; from
/// the lower end and from the number outside of the range one a little above.
double other_number(const Parameter& p, const std::optional<double>& usual) {
    const Range& range = p.range;
    const double lower = std::isfinite(range.lower) ? range.lower : 0.0;
    const bool integer = p.type == "integer";
    if (!usual || *usual == range.word || *usual <= lower)
        return std::min(lower + (integer ? 2.0 : 1.0), range.upper);
    if (range.contains(lower) && (integer || lower == 0.0)) return lower;
    return 0.5 * (*usual + lower);
}

std::string element(const Parameter& p, const std::string& value) {
    return fmt::format(R"(<{} name="{}" value="{}"/>)", p.type, p.name, value);
}

/// One way to set a type up: its parameters as XML.
struct Settings {
    std::vector<std::pair<std::string, std::string>> values;  ///< parameter and element
    Settings with(const std::string& name, const std::string& xml) const {
        Settings result = *this;
        std::erase_if(result.values, [&](const auto& v) { return v.first == name; });
        result.values.emplace_back(name, xml);
        return result;
    }
    std::string xml() const {
        std::string all;
        for (const auto& [name, element] : values) all += element;
        return all;
    }
};

/// The default, or a quicker choice.
const std::string& usual_choice(const Parameter& p) {
    const auto quick = quick_choices.find(p.name);
    return quick != quick_choices.end() ? quick->second : p.default_value;
}

Settings usual(const Manual& manual) {
    Settings settings;
    for (const Parameter& p : manual.parameters)
        if (p.type == "integer" && default_of(p) > double(largest_integer))
            settings.values.emplace_back(p.name, element(p, std::to_string(largest_integer)));
        else if (usual_choice(p) != p.default_value)
            settings.values.emplace_back(p.name, element(p, usual_choice(p)));
    return settings;
}

/// The numbers to be tried besides the usual one.
std::vector<std::string> numbers(const Parameter& p) {
    std::optional<double> usual = default_of(p);
    if (p.type == "integer" && usual) usual = std::min(*usual, double(largest_integer));
    std::vector<std::string> result{element(p, fmt::format("{}", other_number(p, usual)))};
    if (p.range.word && usual != p.range.word) result.push_back(element(p, fmt::format("{}", *p.range.word)));
    return result;
}

std::vector<Settings> variations(const Manual& manual, int nesting);

bool loads(const std::string& type, const Settings& settings) {
    try {
        integrator_from("<integrator type=\"" + type + "\">" + settings.xml() + "</integrator>");
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// The settings that a type is nested with: on the first level its own are varied. Those of integrators are
/// varied where the integrator stands alone, so that nested ones need the usual settings and one other, each
/// type one of another kind.
std::vector<Settings> settings_of_nested(const Manual& manual, Category category, int nesting,
                                         std::size_t number) {
    if (nesting == 0) return {usual(manual)};
    std::vector<Settings> all = variations(manual, nesting - 1);
    if (category != Category::integrator) return all;
    std::erase_if(all, [&](const Settings& s) { return !loads(manual.type, s); });
    if (all.size() < 3) return all;
    return {all[0], all[1 + (3 * number) % (all.size() - 1)]};
}

/// A nested object of every registered type.
std::vector<std::string> nested(const Parameter& p, Category category, int nesting) {
    std::vector<std::string> result;
    for (const std::string& type : registry().types(category)) {
        const Manual& manual = *registry().find(category, type);
        for (const Settings& s : settings_of_nested(manual, category, nesting, result.size()))
            result.push_back(
                fmt::format(R"(<{0} name="{1}" type="{2}">{3}</{0}>)", p.type, p.name, type, s.xml()));
    }
    return result;
}

std::vector<std::string> values_of(const Manual& manual, const Parameter& p, int nesting) {
    std::vector<std::string> result;
    if (p.type == "boolean") {
        result.push_back(element(p, p.default_value == "true" ? "false" : "true"));
    } else if (p.type == "string") {
        if (p.choices.empty() && p.name != "shares")
            FAIL(manual.type << "." << p.name << " declares no choices");
        for (const std::string& word : p.choices.empty() ? shares : p.choices)
            if (word != usual_choice(p)) result.push_back(element(p, word));
    } else if (const auto category = find_category(p.type)) {
        result = nested(p, *category, nesting);
    } else if (p.type == "integer" || p.type == "float") {
        result = numbers(p);
    }
    return result;
}

std::vector<Settings> variations(const Manual& manual, int nesting) {
    std::vector<Settings> result{usual(manual)};
    for (const Parameter& p : manual.parameters)
        for (const std::string& xml : values_of(manual, p, nesting))
            result.push_back(result[0].with(p.name, xml));
    if (nesting == 0) return result;
    for (const Parameter& a : manual.parameters)  // pairs of nested objects, not again in who nests the type
        for (const Parameter& b : manual.parameters)
            if (const auto first = find_category(a.type), second = find_category(b.type);
                first && second && a.name < b.name)
                for (const std::string& one : nested(a, *first, 0))
                    for (const std::string& two : nested(b, *second, 0))
                        result.push_back(result[0].with(a.name, one).with(b.name, two));
    return result;
}

constexpr std::uint32_t passes = 2, passes_before = 1;

/// The film's sums, and the means that post-processes may have replaced.
struct Bits {
    std::vector<std::byte> sums;
    std::vector<std::vector<Rgb>> means;
    bool operator==(const Bits&) const = default;
};

Bits bits(const Film& film) {
    Bits result{film.serialize(), {film.beauty()}};
    for (std::size_t i = 0; i < film.layers().size(); ++i) result.means.push_back(film.mean(i));
    return result;
}

/// In an arena of its own, since a machine of two cores would give two threads whatever is allowed.
template <typename F>
auto on_threads(int threads, const F& work) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    return tbb::task_arena(threads).execute(work);
}

RenderRequest request(std::uint64_t seed = 5) {
    RenderRequest r;
    r.seed = seed, r.stop.passes = passes, r.content_hash = "0123456789abcdef";
    return r;
}

Bits straight(const Scene& scene, const Integrator& integrator, int threads, std::uint64_t seed = 5) {
    return on_threads(threads, [&] { return bits(render(scene, integrator, request(seed)).film); });
}

Bits resumed(const Scene& scene, const Integrator& integrator, int threads) {
    const TemporaryFolder folder;
    return on_threads(threads, [&] {
        std::atomic<bool> flag{false};
        RenderRequest first = request();
        first.checkpoint_path = folder.file("checkpoint");
        RenderRequest second = first;
        first.interrupted = &flag;
        first.progress = [&](const RenderProgress& p) { flag = p.passes == passes_before; };
        const RenderResult cut = render(scene, integrator, first);
        REQUIRE(cut.interrupted);
        REQUIRE(cut.film.pass_count() == passes_before);
        second.resume = true;
        const RenderResult result = render(scene, integrator, second);
        REQUIRE(result.resumed_at == passes_before);
        return bits(result.film);
    });
}

/// Passes 0 .. 4 by two machines, added up.
Bits merged(const Scene& scene, const Integrator& integrator) {
    const auto part = [&](std::uint32_t first, std::uint32_t end, int threads) {
        RenderRequest r = request();
        r.range = PassRange{first, end};
        return on_threads(threads, [&] { return render(scene, integrator, r).film; });
    };
    Film film = part(0, 2, 1);
    film.add(part(2, 5, 4));
    RenderRequest rest = request();
    rest.stop.passes = 5, rest.begin_with = &film;
    return bits(render(scene, integrator, rest).film);
}

/// Where passes go to methods by what was seen before, ranges are refused in words.
void check_ranges(const Scene& scene, const Integrator& integrator) {
    RenderRequest all = request();
    all.stop.passes = 5;
    const Film whole = render(scene, integrator, all).film;
    try {
        const Bits together = merged(scene, integrator);
        CHECK((bits(whole) == together));
    } catch (const InputError& error) {
        CHECK(integrator.type() == "mote_layers");
        CHECK(whole.parts() > 1);
        CHECK(std::string(error.what()).find("integrator.shares with " + std::to_string(whole.parts())) !=
              std::string::npos);
    }
}

constexpr int edge = 20;  ///< of the picture: four tiles

/// The box with three kinds of lights, and a card with holes and bent normals.
/// `in_front`: of the medium, whose border is at z = 0.9; else the lamps stand in it.
std::unique_ptr<Scene> lit_box(const std::string& medium, bool in_front) {
    std::string xml = box(mixed, medium);
    xml.insert(
        xml.find("<sensor"),
        fmt::format(R"(<emitter type="point"><point name="position" x="0.5" y="0.3" z="{}"/>
            <rgb name="intensity" value="1, 2, 3"/></emitter>
        <emitter type="spot"><transform name="to_world"><lookat origin="-0.5, 0.8, {}" target="0, -0.5, 0" up="0, 0, 1"/>
            </transform><rgb name="intensity" value="3, 2, 1"/></emitter>)",
                    in_front ? 1.0 : 0.6, in_front ? 1.1 : 0.8) +
            R"(<shape type="rectangle"><transform name="to_world"><scale value="0.4"/><rotate x="1" angle="-60"/></transform>
            <bsdf type="mask"><texture type="checkerboard" name="opacity"/>)" +
            bent(mixed) + "</bsdf></shape>");
    return scene_from(xml, edge);
}

double brightness(const Bits& bits) {
    double sum = 0.0;
    for (const Rgb& pixel : bits.means[0]) sum += double(average(pixel));
    return sum;
}

/// Every setting of an integrator in a scene. Returns how many were rendered, and enters what was refused.
int check_all(const Scene& scene, const std::string& type, std::set<std::string>& refused) {
    int rendered = 0;
    for (const Settings& s : variations(*registry().find(Category::integrator, type), 1)) {
        INFO(type << " " << s.xml());
        std::shared_ptr<const Integrator> integrator;
        try {
            integrator = integrator_from("<integrator type=\"" + type + "\">" + s.xml() + "</integrator>");
            integrator->prepare(scene, {.seed = 5, .width = edge, .height = edge});
        } catch (const InputError& error) {
            refused.insert(type + ": " + error.what());
            continue;
        }
        const Bits one = straight(scene, *integrator, 1);
        CHECK(brightness(one) > 0.0);
        if (const bool same = one == resumed(scene, *integrator, 4); !same) {
            INFO("interrupted and resumed on one thread the same: "
                 << (one == resumed(scene, *integrator, 1)));
            INFO("in one continue four threads the same: " << (one == straight(scene, *integrator, 4)));
            CHECK(same);
        }
        if (rendered == 0 || s.xml().find("\"shares\"") != std::string::npos)
            check_ranges(scene, *integrator);
        if (rendered++ == 0) CHECK_FALSE((one == straight(scene, *integrator, 1, 6)));
    }
    return rendered;
}

/// Errors of the two kinds that are looked for.
enum class Carelessness { threads, state };

class CarelessEstimator final : public Estimator {
  public:
    explicit CarelessEstimator(Carelessness how) : how_(how) {}
    bool pass(const PassContext&, PassImage& image) override {
        ++passes_;
        const int value = how_ == Carelessness::threads ? tbb::this_task_arena::max_concurrency() : passes_;
        for (Rgb& pixel : image.layer(0)) pixel = Rgb(float(value));
        return true;
    }

  private:
    Carelessness how_;
    int passes_ = 0;
};
using Careless = IntegratorOf<CarelessEstimator>;

}  // namespace

TEST_CASE("every integrator gives the same bits on one thread, and on many after a resume", "[same_bits]") {
    const TemporaryFolder folder;
    const Environment off("MOTE_OIDN", "off");  // bits are those of mote
    std::set<std::string> refused;
    for (const auto& medium :
         {std::string(), fog("0.8, 1.0, 1.3", ""), smoke_medium(folder.file("smoke.vol"))}) {
        // Paths sample light of lamps in media along themselves; of others mote_layers marches it.
        const auto scene = lit_box(medium, medium.find("heterogeneous") != std::string::npos);
        INFO("medium " << medium);
        for (const std::string& type : registry().types(Category::integrator)) {
            const int rendered = check_all(*scene, type, refused);
            CHECK((rendered > 0) ==
                  (!scene->has_media() ||
                   (type != "mote_vsl" && type != "mote_vpl_ray_bundles" && type != "mote_micro_rendering")));
        }
    }
    // Nothing else is left out.
    for (const std::string& why : refused) UNSCOPED_INFO(why);
    REQUIRE(refused.size() == 24);

    const auto count = [&](const std::string& why) {
        return std::count_if(refused.begin(), refused.end(),
                             [&](const std::string& text) { return text.find(why) != std::string::npos; });
    };
    CHECK(count("OpenImageDenoise is not loaded") == 1);
    CHECK(count("mote_layers: shares has") == 4);  // one method, or three, and other numbers of shares
    CHECK(count("'media' is compensated in the passes") == 1);
    // mote_vsl, mote_vpl_ray_bundles and mote_micro_rendering, alone and in mote_layers
    CHECK(count("renders surfaces only") == 6);
    // Selections of mote_vpl with compensation and with two kinds of maps
    CHECK(count("a selection of VPLs does not go together with") == 3);
    CHECK(count("works on the mean of its whole picture") ==
          2);  // mote_layers and a filtered mote_vpl in mote_layers
    // Single numbers that only go with others: points of imperfect maps, texels of an atlas alone and nested
    CHECK(count("'all_points' is 1 but must be at least 40") == 3);
    CHECK(count("texels") == 3);
    CHECK(count("imperfect bundles have no panes") == 1);
}

TEST_CASE("a pass that depends on its threads or its predecessors gives other bits", "[same_bits][planted]") {
    const auto scene = lit_box("", false);
    const Careless threads(Carelessness::threads), state(Carelessness::state);
    CHECK_FALSE((straight(*scene, threads, 1) == straight(*scene, threads, 4)));
    CHECK((straight(*scene, threads, 4) == resumed(*scene, threads, 4)));
    CHECK_FALSE((straight(*scene, state, 1) == resumed(*scene, state, 1)));
    CHECK((straight(*scene, state, 1) == straight(*scene, state, 4)));
}
