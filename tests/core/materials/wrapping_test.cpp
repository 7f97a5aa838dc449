// BSDFs that hold others: what they mean, to the number; how light sees what the eye sees; what they refuse.
#include "core/scene/scattering_vertex.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb;
using core::TransportMode;
using core::Vec3;

namespace {

const core::BsdfPoint point{};

/// A scene that holds one BSDF, for the loader's sake.
std::string scene_of(const std::string& bsdf) {
    return R"(<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/><shape type="sphere">)" +
           bsdf + "</shape></scene>";
}
core::BsdfPtr loaded(const std::string& bsdf) { return scene_from(scene_of(bsdf), 1)->shapes()[0]->bsdf; }
std::string refusal(const std::string& bsdf) {
    try {
        scene_from(scene_of(bsdf), 1);
    } catch (const core::InputError& e) {
        return e.what();
    }
    return "";
}

/// Left half 0, right half 1.
std::shared_ptr<core::Texture> step() {
    return core::make_bitmap_texture({2, 1, {Rgb(0.0f), Rgb(1.0f)}},
                                     {.filter = core::TextureFilter::nearest});
}

float radiance(const core::Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
    return bsdf.eval(point, wo, wi, TransportMode::radiance).x;
}

}  // namespace

TEST_CASE("a mask divides light between passing and its BSDF, where its texture says", "[materials][mask]") {
    const auto leaf = core::make_mask(core::make_diffuse(grey(0.6f)), step());
    const Vec3 wo = direction_at(0.7, 1.0);
    const core::BsdfPoint hole{{0.2f, 0.5f}}, blade{{0.8f, 0.5f}};
    CHECK(leaf->straight_passage(hole, wo).probability() == 1.0f);
    CHECK(leaf->straight_passage(hole, wo).weight == Rgb(1.0f));
    CHECK(leaf->straight_passage(blade, wo).stops == 1.0f);
    CHECK(leaf->sample(hole, wo, 0.0f, {0.5f, 0.5f}, TransportMode::radiance)->wi == -wo);
    CHECK_FALSE(
        leaf->sample(blade, wo, core::one_minus_epsilon, {0.5f, 0.5f}, TransportMode::radiance)->delta);
    CHECK(core::is_black(leaf->eval(hole, wo, wo, TransportMode::radiance)));
    CHECK(leaf->eval(blade, wo, wo, TransportMode::radiance).x == Approx(0.6 / 3.14159265));
    CHECK((leaf->traits().pane && leaf->traits().passes_straight() && !leaf->traits().null));
    CHECK_FALSE(leaf->traits().tints);

    // Values beyond 0 to 1 are cut; in a mask in a mask weights multiply; tinted glass tints what passes.
    CHECK(core::make_mask(core::make_diffuse(), grey(3.0f))->straight_passage(point, wo).stops == 1.0f);
    CHECK(core::make_mask(core::make_diffuse(), grey(-1.0f))->straight_passage(point, wo).stops == 0.0f);
    const auto twice = core::make_mask(core::make_mask(core::make_diffuse(), grey(0.5f)), grey(0.4f));
    CHECK(twice->straight_passage(point, wo).stops == Approx(0.2));
    const auto red = core::make_constant_texture({0.9f, 0.5f, 0.1f});
    const auto pane = core::make_thin_dielectric({1.5f, 1.0f, grey(1.0f), red});
    const auto masked = core::make_mask(pane, grey(0.25f));
    const Rgb expected = 0.75f + 0.25f * pane->straight_passage(point, wo).transmittance();
    const Rgb passes = masked->straight_passage(point, wo).transmittance();
    for (int c = 0; c < 3; ++c) CHECK(passes[c] == Approx(expected[c]));
    CHECK((masked->traits().tints &&
           !core::make_mask(core::make_thin_dielectric({}), grey(0.5f))->traits().tints));
}

TEST_CASE("a blend whose one part is black reflects all that the other part gets", "[materials][mask]") {
    const auto black = core::make_diffuse(grey(0.0f)), white = core::make_diffuse(grey(0.8f));
    for (const bool first : {false, true}) {
        const auto blend = core::make_blend(first ? black : white, first ? white : black, grey(0.5f));
        const Vec3 wo = direction_at(0.7, 1.0);
        core::Rng rng(5);
        const int n = 4000;
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const float lobe = rng.next_float();
            const core::Vec2 u = rng.next_vec2();
            if (const auto s = blend->sample(point, wo, lobe, u, TransportMode::radiance)) sum += s->weight.x;
        }
        // Half of the samples come back, with weight 0.8 each: four standard errors of 0.4 / sqrt(n).
        CHECK(sum / n == Approx(0.4).margin(4 * 0.4 / std::sqrt(n)));
    }
}

TEST_CASE("the chances of sample() are those of straight_passage()", "[materials][mask]") {
    for (const BsdfCase& c : all_cases()) {
        if (!c.bsdf->traits().pane) continue;
        core::Rng rng(31);
        for (int i = 0; i < 300; ++i) {
            const Vec3 wo = random_direction(rng);
            const core::StraightPassage passage = c.bsdf->straight_passage(point, wo);
            const core::Vec2 u = rng.next_vec2();
            CAPTURE(c.name, passage.stops);
            const auto straight = [&](float u_lobe) {
                const auto s = c.bsdf->sample(point, wo, u_lobe, u, TransportMode::radiance);
                return s && s->delta && s->wi == -wo;
            };
            // Whatever a vertex samples that was stopped there by chance lies below.
            CHECK_FALSE((passage.stops > 0.0f && straight(core::one_minus_epsilon * passage.stops)));
            CHECK((passage.stops == 1.0f || straight(std::fmax(passage.stops, 0.0f))));
        }
    }
}

TEST_CASE("a vertex on a mask that stopped a path scatters as if there were no holes", "[materials][mask]") {
    const auto inner = core::make_rough_plastic({1.5f, 1.0f, grey(0.5f), grey(1.0f), false}, beckmann(0.3f));
    const auto mask = core::make_mask(inner, grey(0.3f)),
               diffuse = core::make_mask(core::make_diffuse(), grey(0.3f));
    core::Rng rng(32);
    core::ScatteringVertex plain, stopped;
    plain.bsdf = inner.get(), stopped.bsdf = mask.get();
    stopped.wo = plain.wo = direction_at(0.6, 2.0);
    stopped.stop_chance = mask->straight_passage(point, stopped.wo).stops;
    for (int i = 0; i < 200; ++i) {
        const Vec3 wi = random_direction(rng);
        CHECK(stopped.eval(wi, TransportMode::radiance).x ==
              Approx(plain.eval(wi, TransportMode::radiance).x).epsilon(1e-5));
        CHECK(stopped.pdf_solid_angle(wi, TransportMode::radiance) ==
              Approx(plain.pdf_solid_angle(wi, TransportMode::radiance)).epsilon(1e-5));
        const float u_lobe = rng.next_float();
        const core::Vec2 u = rng.next_vec2();
        const auto a = stopped.sample(u_lobe, u, TransportMode::radiance),
                   b = plain.sample(u_lobe, u, TransportMode::radiance);
        REQUIRE(a.has_value() == b.has_value());
        if (!a) continue;
        CHECK(glm::distance(a->wi, b->wi) < 1e-3f);
        CHECK(a->weight.x == Approx(b->weight.x).epsilon(1e-3));
    }
    stopped.bsdf = diffuse.get();
    CHECK(stopped.diffuse_reflectance()->x == Approx(0.5));
}

TEST_CASE("a blend is the sum of its parts", "[materials][blend]") {
    const auto a = core::make_diffuse(grey(0.9f)), b = core::make_rough_conductor(gold(), ggx(0.3f));
    const auto blend = core::make_blend(a, b, grey(0.25f));
    core::Rng rng(33);
    for (int i = 0; i < 100; ++i) {
        const Vec3 wo = random_direction(rng), wi = random_direction(rng);
        CHECK(radiance(*blend, wo, wi) ==
              Approx(0.75 * double(radiance(*a, wo, wi)) + 0.25 * double(radiance(*b, wo, wi))));
    }
    CHECK_FALSE(blend->traits().pane);
    CHECK(core::make_blend(a, core::make_diffuse(grey(0.1f)), grey(0.25f))
              ->diffuse_reflectance(point, {0, 0, 1})
              ->x == Approx(0.7));
    // At 0 and 1 there is one alone, sampled with the same numbers.
    const Vec3 wo = direction_at(0.5, 1.0);
    for (const float u : {0.0f, 0.3f, core::one_minus_epsilon}) {
        const auto first =
            core::make_blend(a, b, grey(0.0f))->sample(point, wo, u, {0.2f, 0.9f}, TransportMode::power);
        const auto second =
            core::make_blend(a, b, grey(1.0f))->sample(point, wo, u, {0.2f, 0.9f}, TransportMode::power);
        CHECK(first->wi == a->sample(point, wo, u, {0.2f, 0.9f}, TransportMode::power)->wi);
        CHECK(second->wi == b->sample(point, wo, u, {0.2f, 0.9f}, TransportMode::power)->wi);
    }
}

// Numbers of Mitsuba 3.9.1 (eval() over the cosine of the frame's normal, pdf()); wi as in Mitsuba is our wo.
TEST_CASE("a normal map is Mitsuba's", "[materials][normalmap]") {
    struct Row {
        Vec3 colour, wo, wi;
        bool flip, shadow;
        double f_cos, pdf;
    };
    // colour, wo, wi, flip_invalid_normals, use_shadowing_function, f cos, pdf
    const std::vector<Row> rows = {
        {{0.74f, 0.75f, 0.81f}, {0.42f, 1.14f, 0.11f}, {-0.55f, -0.78f, 0.76f}, false, false, 0, 0},
        {{0.62f, 0.29f, 0.77f},
         {1.60f, 0.20f, 1.73f},
         {-0.08f, -1.16f, 0.64f},
         true,
         false,
         0.1345704,
         0.2691409},
        {{0.15f, 0.54f, 0.71f}, {-0.06f, -0.59f, 0.41f}, {0.83f, -1.64f, 0.27f}, false, true, 0, 0},
        {{0.11f, 0.67f, 0.60f},
         {-0.04f, -0.30f, 1.05f},
         {-0.40f, -1.09f, 1.37f},
         true,
         true,
         0.01890242,
         0.04368016},
        {{0.11f, 0.85f, 0.63f},
         {-1.18f, 0.74f, 1.10f},
         {-0.33f, -0.84f, 1.46f},
         false,
         false,
         0.004207674,
         0.008415348},
        {{0.40f, 0.74f, 0.68f},
         {-0.15f, 0.24f, 0.10f},
         {-0.86f, 0.90f, 1.31f},
         true,
         false,
         0.1497796,
         0.2995593},
        {{0.89f, 0.68f, 0.92f},
         {-0.36f, -0.97f, 1.14f},
         {0.42f, -1.05f, 1.28f},
         false,
         true,
         0.07754726,
         0.1589554},
        {{0.87f, 0.35f, 0.76f},
         {-0.01f, -0.45f, 0.05f},
         {1.34f, -0.52f, 1.27f},
         true,
         true,
         0.1448601,
         0.3148811},
        {{0.31f, 0.49f, 0.82f},
         {-1.58f, 1.73f, 0.35f},
         {-0.94f, 0.91f, 0.03f},
         false,
         false,
         0.05850677,
         0.1170135},
        {{0.26f, 0.37f, 0.97f},
         {0.05f, 1.07f, 0.33f},
         {0.42f, 1.88f, 1.22f},
         true,
         false,
         0.02930639,
         0.05861278},
        {{0.73f, 0.85f, 0.75f},
         {-1.46f, 1.95f, 1.09f},
         {-1.06f, 1.38f, 0.04f},
         false,
         true,
         0.003488264,
         0.09343471},
        {{0.68f, 0.53f, 0.73f},
         {1.59f, -0.79f, 0.25f},
         {-0.28f, -0.38f, 0.92f},
         true,
         true,
         0.07812991,
         0.1570648},
        {{0.12f, 0.55f, 0.80f},
         {-0.93f, -1.15f, 0.12f},
         {-0.71f, -0.63f, 1.69f},
         false,
         false,
         0.125731,
         0.251462},
        {{0.30f, 0.54f, 0.87f},
         {0.91f, 1.34f, 2.39f},
         {-0.55f, -0.39f, 0.66f},
         true,
         false,
         0.1351899,
         0.2703798},
        {{0.50f, 0.54f, 0.78f},
         {0.39f, -0.87f, 0.51f},
         {0.25f, 1.88f, 0.02f},
         false,
         true,
         0.008135922,
         0.04794335},
        {{0.58f, 0.88f, 0.96f},
         {1.77f, 1.72f, 0.86f},
         {0.33f, 1.14f, 0.15f},
         true,
         true,
         0.06554899,
         0.2336487},
    };
    for (const Row& row : rows) {
        const auto bsdf = core::make_normal_map(
            core::make_diffuse(grey(0.5f)), core::make_constant_texture(row.colour), {row.flip, row.shadow});
        const Vec3 wo = glm::normalize(row.wo), wi = glm::normalize(row.wi);
        CAPTURE(row.colour.x, row.colour.y, row.colour.z, row.flip, row.shadow);
        CHECK(double(radiance(*bsdf, wo, wi) * std::fabs(wi.z)) ==
              Approx(row.f_cos).epsilon(1e-4).margin(1e-7));
        CHECK(double(bsdf->pdf_solid_angle(point, wo, wi, TransportMode::radiance)) ==
              Approx(row.pdf).epsilon(1e-4).margin(1e-7));
    }
    CHECK(rows.size() >= 10);
}

TEST_CASE("a bump map bends the normal as the slope of its heights does", "[materials][bumpmap]") {
    // A ramp of height u: 1 m over dp/du = 2 m is a slope of 1/2; mirrored by dp/dv it stays.
    const core::Bitmap ramp{2, 2, {Rgb(0.0f), Rgb(1.0f), Rgb(0.0f), Rgb(1.0f)}};
    const core::BentNormalSettings bare{false, false};
    const auto clamped = core::make_bitmap_texture(ramp, {.wrap = core::TextureWrap::clamp});
    CHECK(clamped->scalar_gradient({0.5f, 0.5f}).x == Approx(2.0));  // between texel centres at 1/4 and 3/4
    CHECK(clamped->scalar_gradient({0.5f, 0.5f}).y == 0.0f);
    CHECK(clamped->scalar_gradient({0.1f, 0.5f}).x == 0.0f);
    const auto nearest = core::make_bitmap_texture(ramp, {.filter = core::TextureFilter::nearest});
    CHECK(nearest->scalar_gradient({0.5f, 0.5f}) == core::Vec2(0.0f));
    core::BsdfPoint p{{0.5f, 0.5f}};
    p.dp_du = {2.0f, 0.0f, 0.0f};
    for (const float across : {3.0f, -3.0f}) {
        p.dp_dv = {0.5f, across, 0.0f};
        const auto bump = core::make_bump_map(core::make_diffuse(grey(1.0f)), clamped, 0.5f, bare);
        // Slope 2 * 0.5 / 2 = 0.5 along x, and none along dp/dv = (0.5, +-3): the plane's normal by hand.
        Vec3 n = glm::cross(Vec3(2.0f, 0.0f, 1.0f), Vec3(0.5f, across, 0.0f));
        n = glm::normalize(n.z > 0.0f ? n : -n);
        const Vec3 wo(0.0f, 0.0f, 1.0f), wi = direction_at(0.8, 2.0);
        CHECK(bump->eval(p, wo, wi, TransportMode::radiance).x * wi.z ==
              Approx(glm::dot(wi, n) / core::pi).epsilon(1e-5));
    }
    // Where nothing is known of the surface, and where nothing slopes, it does nothing.
    const auto bump = core::make_bump_map(core::make_diffuse(grey(1.0f)), clamped, 0.5f);
    const Vec3 wo = direction_at(0.4, 1.0), wi = direction_at(0.8, 2.0);
    CHECK(radiance(*bump, wo, wi) == Approx(1.0 / 3.14159265));
    p.uv = {0.1f, 0.5f};
    CHECK(bump->eval(p, wo, wi, TransportMode::radiance).x == Approx(1.0 / 3.14159265));
}

TEST_CASE("the gradient of a picture is the slope of what it shows", "[materials][texture][bumpmap]") {
    core::Rng rng(34);
    core::Bitmap picture{5, 4, std::vector<Rgb>(20)};
    for (Rgb& c : picture.pixels) c = {rng.next_float(), rng.next_float(), rng.next_float()};
    core::Transform turned(glm::dmat4(1.0));
    turned.matrix[0] = {1.5, 0.7, 0.0, 0.0}, turned.matrix[1] = {-0.4, 2.0, 0.0, 0.0};
    for (const auto wrap : {core::TextureWrap::repeat, core::TextureWrap::mirror, core::TextureWrap::clamp}) {
        const auto texture = core::make_bitmap_texture(picture, {.wrap = wrap, .to_uv = turned});
        int right = 0;
        for (int i = 0; i < 400; ++i) {
            const core::Vec2 uv(3.0f * rng.next_float() - 1.5f, 3.0f * rng.next_float() - 1.5f);
            constexpr float h = 1.0f / 512.0f;
            const auto slope = [&](const core::Vec2& step) {
                return (texture->scalar(uv + h * step) - texture->scalar(uv - h * step)) / (2.0f * h);
            };
            const core::Vec2 numeric(slope({1, 0}), slope({0, 1}));
            right += glm::distance(numeric, texture->scalar_gradient(uv)) < 0.02f;
        }
        // Within a bilinear patch central differences are exact; one step in ten leaves it.
        CHECK(right > 320);
    }
}

TEST_CASE("wrapping BSDFs are read, nest in each other, and refuse what Mitsuba refuses",
          "[materials][loading]") {
    const std::string diffuse = R"(<bsdf type="diffuse"/>)";
    const std::string mask =
        R"(<bsdf type="mask"><float name="opacity" value="0.25"/>)" + diffuse + "</bsdf>";
    const std::string normal = R"(<bsdf type="normalmap"><rgb name="normalmap" value="0.5, 0.6, 0.9"/>)";
    const std::string bump = R"(<bsdf type="bumpmap"><texture type="checkerboard" name="any"/>)";
    CHECK(loaded(mask)->straight_passage(point, {0, 0, 1}).stops == 0.25f);
    CHECK(loaded(normal + mask + "</bsdf>")->straight_passage(point, {0, 0, 1}).stops == 0.25f);
    CHECK(loaded(bump + normal + diffuse + "</bsdf></bsdf>")->traits().anisotropic);
    CHECK(loaded("<bsdf type='twosided'>" + bump + normal + diffuse + "</bsdf></bsdf></bsdf>")
              ->traits()
              .smooth);
    // The order of the file counts, not the names.
    const std::string white = R"(<bsdf type="diffuse" name="z"><rgb name="reflectance" value="1"/></bsdf>)",
                      black = R"(<bsdf type="diffuse" name="a"><rgb name="reflectance" value="0"/></bsdf>)";
    const auto blend =
        loaded(R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>)" + white + black + "</bsdf>");
    CHECK(blend->diffuse_reflectance(point, {0, 0, 1})->x == Approx(0.75));

    CHECK_THAT(refusal("<bsdf type='twosided'>" + mask + "</bsdf>"), ContainsSubstring("transmits"));
    CHECK_THAT(refusal("<bsdf type='mask'/>"), ContainsSubstring("needs one nested BSDF"));
    CHECK_THAT(refusal("<bsdf type='mask'>" + white + black + "</bsdf>"), ContainsSubstring("not more"));
    CHECK_THAT(refusal("<bsdf type='blendbsdf'>" + diffuse + "</bsdf>"),
               ContainsSubstring("needs 2 nested BSDFs"));
    CHECK_THAT(refusal("<bsdf type='normalmap'>" + diffuse + "</bsdf>"), ContainsSubstring("'normalmap'"));
    CHECK_THAT(refusal("<bsdf type='bumpmap'>" + diffuse + "</bsdf>"),
               ContainsSubstring("needs the parameter 'texture'"));
    CHECK_THAT(refusal(mask + R"(<emitter type="area"/>)"), ContainsSubstring("lets light pass straight on"));
}
