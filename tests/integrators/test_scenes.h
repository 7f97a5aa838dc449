// Scenes that several tests of integrators render, as XML text.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <string>

#include "tests/support/render_statistics.h"

namespace mote::tests {

/// A box of five walls with a lamp and a block; `wall` is the BSDF of walls and block, `inside` a medium or
/// "".
inline std::string box(const std::string& wall, const std::string& medium) {
    const auto rectangle = [&](const std::string& transform) {
        return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + "</transform>" + wall +
               "</shape>";
    };
    std::string xml = "<scene version=\"3.0.0\">";
    xml += rectangle("<translate z=\"-1\"/>");                                 // back, facing +z
    xml += rectangle("<translate z=\"-1\"/><rotate x=\"1\" angle=\"-90\"/>");  // floor, facing +y
    xml += rectangle("<translate z=\"-1\"/><rotate x=\"1\" angle=\"90\"/>");   // ceiling
    xml += rectangle("<translate z=\"-1\"/><rotate y=\"1\" angle=\"90\"/>");   // left, facing +x
    xml += rectangle("<translate z=\"-1\"/><rotate y=\"1\" angle=\"-90\"/>");  // right
    xml +=
        "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0.3\"/><rotate y=\"1\" "
        "angle=\"25\"/>"
        "<translate x=\"0.3\" y=\"-0.7\" z=\"-0.2\"/></transform>" +
        wall + "</shape>";
    xml +=
        R"(<shape type="rectangle"><transform name="to_world"><scale value="0.25"/><rotate x="1" angle="90"/>
        <translate y="0.95"/></transform><emitter type="area"><rgb name="radiance" value="10, 8, 6"/></emitter></shape>)";
    if (!medium.empty())
        xml +=
            "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"0.9\" y=\"0.85\" "
            "z=\"0.9\"/></transform>"
            "<bsdf type=\"null\"/>" +
            medium + "</shape>";
    xml += R"(<sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    return xml;
}

/// The scene with more shapes and lights.
inline std::string with(std::string xml, const std::string& more) {
    return xml.insert(xml.find("<sensor"), more);
}

/// The scene without its lamp, whose rectangle stays.
inline std::string without_area_light(std::string xml) {
    const auto lamp = xml.find("<emitter type=\"area\">");
    return xml.erase(lamp, xml.find("</emitter>", lamp) + 10 - lamp);
}

/// The scene with another sensor in place of its own.
inline std::string with_sensor(std::string xml, const std::string& sensor) {
    const auto from = xml.find("<sensor"), to = xml.find("</sensor>");
    return xml.replace(from, to + 9 - from, sensor);
}

inline const std::string grey =
    R"(<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>)";
inline const std::string glossy =
    R"(<bsdf type="twosided"><bsdf type="roughconductor"><float name="alpha" value="0.35"/>
    <rgb name="specular_reflectance" value="0.7"/></bsdf></bsdf>)";
inline const std::string mixed =
    R"(<bsdf type="twosided"><bsdf type="roughplastic"><float name="alpha" value="0.3"/>
    <rgb name="diffuse_reflectance" value="0.5, 0.4, 0.3"/></bsdf></bsdf>)";

/// Two normals in squares, bent one way and the other, over `nested`.
inline std::string bent(const std::string& nested) {
    return R"(<bsdf type="normalmap"><texture type="checkerboard" name="normalmap"><rgb name="color0" value="0.68, 0.45, 0.95"/>
        <rgb name="color1" value="0.4, 0.7, 0.9"/><transform name="to_uv"><scale x="2" y="3"/></transform></texture>)" +
           nested + "</bsdf>";
}

/// The box with bent normals on its walls, a card with holes below the lamp, and a ball half of which is
/// there.
inline std::string leafy_box(const std::string& medium) {
    std::string xml =
        box(R"(<bsdf type="twosided">)" +
                bent(R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>)") +
                "</bsdf>",
            medium);
    xml.insert(xml.find("<sensor"),
               R"(<shape type="rectangle"><transform name="to_world"><scale x="0.6" y="0.5"/>
        <rotate x="1" angle="-70"/><translate y="0.3"/></transform><bsdf type="mask">
        <texture type="checkerboard" name="opacity"><float name="color0" value="0.1"/><float name="color1" value="0.9"/>
        <transform name="to_uv"><scale x="3" y="2"/></transform></texture><bsdf type="twosided"><bsdf type="diffuse">
        <rgb name="reflectance" value="0.3, 0.7, 0.2"/></bsdf></bsdf></bsdf></shape>
        <shape type="sphere"><float name="radius" value="0.3"/><point name="center" x="-0.45" y="-0.5" z="0.2"/>
        <bsdf type="mask"><float name="opacity" value="0.5"/>)" +
                   bent(R"(<bsdf type="roughplastic"><float name="alpha" value="0.3"/></bsdf>)") +
                   "</bsdf></shape>");
    return xml;
}

inline std::string fog(const std::string& sigma_t, const std::string& phase) {
    return fmt::format(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="{}"/>
        <rgb name="albedo" value="0.9, 0.8, 0.7"/>{}</medium>)",
                       sigma_t, phase);
}

/// A .vol grid of smooth puffs with empty space around them, in [-1,1]^3.
inline std::string smoke_medium(const std::string& path) {
    const std::int32_t n = 16;
    std::ofstream file(path, std::ios::binary);
    const auto write = [&](auto value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
    file.write("VOL\3", 4);
    for (const std::int32_t v : {1, n, n, n, 1}) write(v);
    for (const float v : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f}) write(v);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const float a =
                    std::sin(0.7f * float(x)) * std::sin(0.5f * float(y) + 1.f) * std::cos(0.6f * float(z));
                write(a > 0.2f ? a : 0.0f);
            }
    return fmt::format(R"(<medium type="heterogeneous" name="interior"><float name="scale" value="5"/>
        <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>
        <volume name="albedo" type="constvolume"><rgb name="value" value="0.9, 0.8, 0.7"/></volume></medium>)",
                       path);
}

/// A small glowing cube above the floor of the box.
inline std::string glowing_cube(bool heterogeneous) {
    const std::string medium =
        heterogeneous
            ? R"(<medium type="heterogeneous" name="interior"><volume name="sigma_t" type="constvolume">
            <rgb name="value" value="1, 2, 4"/></volume><rgb name="albedo" value="0.3, 0.5, 0.7"/>
            <rgb name="Le" value="30, 40, 50"/></medium>)"
            : R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="1, 2, 4"/>
            <rgb name="albedo" value="0.3, 0.5, 0.7"/><rgb name="Le" value="30, 40, 50"/></medium>)";
    return R"(<shape type="cube"><transform name="to_world"><scale value="0.2"/>
        <rotate y="1" angle="30"/><translate x="-0.35" y="-0.5" z="0.2"/></transform><bsdf type="null"/>)" +
           medium + "</shape>";
}

/// Choices by which pictures are quick: a trial takes longer than a few passes of few pixels.
inline const std::map<std::string, std::string> quick_choices = {{"efforts", "equal"}};

/// Numbers and choices that keep pictures quick, where an integrator has them.
inline std::string quick_settings(const std::string& type) {
    const std::map<std::string, int> numbers = {
        {"paths", 40},       {"photon_paths", 200}, {"directions", 32}, {"texel_budget", 400},
        {"lines", 24},       {"points", 120},       {"size", 6},        {"light_size", 8},
        {"micro_buffer", 3}, {"steps", 4},          {"candidates", 24}};
    std::string xml;
    for (const core::Parameter& p : registry().find(core::Category::integrator, type)->parameters)
        if (const auto it = numbers.find(p.name); it != numbers.end())
            xml += fmt::format(R"(<integer name="{}" value="{}"/>)", p.name, it->second);
        else if (const auto quick = quick_choices.find(p.name); quick != quick_choices.end())
            xml += fmt::format(R"(<string name="{}" value="{}"/>)", p.name, quick->second);
    return xml;
}

}  // namespace mote::tests
