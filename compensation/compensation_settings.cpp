#include "compensation/compensation_settings.h"

namespace mote::compensation {

using namespace core;

namespace {

/// Strategy and placement together, as scene files name them.
enum class Joining : std::uint8_t { one_to_n, n_to_one, one_to_one, one_to_one_homogeneous };
enum class Receivers : std::uint8_t { all, surfaces, media };

const Choices<Joining> joinings{{"1-to-n", Joining::one_to_n},
                                {"n-to-1", Joining::n_to_one},
                                {"1-to-1", Joining::one_to_one},
                                {"1-to-1-homogeneous", Joining::one_to_one_homogeneous}};

/// The parameters of a scene file, and what they set.
struct CompensationFile {
    Joining joining = Joining::one_to_n;
    Receivers receivers = Receivers::all;
    CompensationSettings settings;
};

Rows<CompensationFile> common_rows() {
    using S = CompensationFile;
    return {row("strategy", &S::joining, joinings,
                "1-to-n: a receiver makes one vertex, joined to all VPLs; n-to-1: one vertex for each VPL; "
                "1-to-1: like n-to-1, and VPLs are shared out among the receivers along the eye ray; "
                "1-to-1-homogeneous: like 1-to-1, with vertices always inside the bounding region."),
            row("receivers", &S::receivers,
                {{"all", Receivers::all}, {"surfaces", Receivers::surfaces}, {"media", Receivers::media}},
                "Receivers whose light is compensated.")};
}

ParameterList<CompensationFile> approximate_rows() {
    using S = CompensationSettings;
    CompensationFile defaults;
    defaults.joining = Joining::one_to_one_homogeneous;
    defaults.settings.depth = 1, defaults.settings.local_visibility = false;
    defaults.settings.transmittance = LocalTransmittance::mean;
    return {
        defaults,
        {common_rows(),
         within(&CompensationFile::settings,
                row("depth", &S::depth, between(0, 1000).or_else(-1, "no limit"), "Steps of the recursion."),
                row("local_visibility", &S::local_visibility,
                    "Rays from receivers in media look for surfaces and boundaries; from surfaces they "
                    "always do."),
                row("transmittance", &S::transmittance,
                    {{"mean", LocalTransmittance::mean}, {"exact", LocalTransmittance::exact}},
                    "Inside the bounding region: from the mean extinction there, or exact."))}};
}

std::shared_ptr<Compensation> make(const CompensationFile& file) {
    CompensationSettings s = file.settings;
    s.enabled = true;
    s.strategy = file.joining == Joining::one_to_n   ? Strategy::one_to_n
                 : file.joining == Joining::n_to_one ? Strategy::n_to_one
                                                     : Strategy::one_to_one;
    s.placement =
        file.joining == Joining::one_to_one_homogeneous ? Placement::in_region : Placement::free_path;
    s.surfaces = file.receivers != Receivers::media, s.media = file.receivers != Receivers::surfaces;
    return std::make_shared<Compensation>(s);
}

}  // namespace

std::string CompensationSettings::strategy_name() const {
    if (strategy == Strategy::one_to_one && placement == Placement::in_region)
        return joinings.word(Joining::one_to_one_homogeneous);
    return joinings.word(Joining(strategy));
}

void register_compensation(Registry& registry) {
    add_type(registry, Category::compensation, "none",
             "Nothing: the bound darkens light over short distances.", R"(<compensation type="none"/>)",
             [] { return std::make_shared<Compensation>(CompensationSettings{}); });
    add_type(registry, Category::compensation, "exact",
             "Brings back all light that the bound takes (Kollig and Keller 2006; Raab et al. 2008).",
             ParameterList<CompensationFile>{common_rows()}, R"(<compensation type="exact"/>)", make);
    add_type(registry, Category::compensation, "approximate",
             "Approximate bias compensation (Engelhardt 2013, Sec. 10.2).", approximate_rows(),
             R"(<compensation type="approximate"><integer name="depth" value="2"/></compensation>)", make);
}

}  // namespace mote::compensation
