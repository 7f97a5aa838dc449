// Writes the reference of the scene language from the registry, so that page and program cannot disagree.
#include "core/formats/xml/scene_format.h"

#include "core/formats/xml/mitsuba_features.h"

namespace mote::core {
namespace {

constexpr const char* introduction = R"(# The scene format

A scene is an XML file in a subset of Mitsuba 3's language: the same elements, parameters, defaults and
conventions, so that one file can be given to both renderers. An element, type or parameter that is not on this
page is an error with file, line and the nearest known name; nothing is skipped in silence, and all errors of a
scene are reported at once. A parameter of Mitsuba that changes nothing here gives a warning. With `--lenient` what is
wrong or unknown is left out or approximated instead, and listed in the log, the statistics and the picture's
metadata (`approximations`). With `--integrator` whatever is wrong with the file's own integrator is a warning.
Further integrators, each of another type, are what a scene sets for these methods: `--integrator TYPE` and the methods of a trade
take their parameters from the scene's integrator of that type, else from its first, which renders where nothing else is requested.

```xml
<scene version="3.0.0">
    <default name="size" value="512"/>
    <integrator type="path"/>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm">
            <integer name="width" value="$size"/>
            <integer name="height" value="$size"/>
        </film>
    </sensor>
    <bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.8"/></bsdf>
    <shape type="rectangle">
        <transform name="to_world"><rotate x="1" angle="-90"/><scale value="3"/></transform>
        <ref id="white"/>
    </shape>
    <emitter type="point">
        <point name="position" x="0" y="3" z="2"/>
        <rgb name="intensity" value="10, 9, 8"/>
    </emitter>
</scene>
```

## Values

| element | holds |
|---|---|
| `<boolean name="…" value="true"/>` | `true` or `false` |
| `<integer name="…" value="3"/>` | a whole number |
| `<float name="…" value="0.5"/>` | a number; an integer will do as well |
| `<string name="…" value="…"/>` | text, file names |
| `<rgb name="…" value="0.2, 0.4, 0.8"/>` | linear RGB, three numbers or one for grey; `#b03020` is a display colour (sRGB), decoded; Mitsuba 3.9.1 refuses that |
| `<spectrum name="…" value="400:0.1, 700:0.8"/>` | a table of wavelength [nm] and value, converted to RGB: a reflectance under daylight (D65), or light as it is; a single number is grey |
| `<point name="…" x="1" y="2" z="3"/>`, `<vector …/>` | also `value="1, 2, 3"` |
| `<transform name="…">…</transform>` | see below |

Numbers are split by spaces or commas. NaN, infinity and numbers beyond single precision are refused.

Lengths are metres, angles degrees, times seconds. Radiance is in W/(m² sr), radiant intensity in W/sr, irradiance
in W/m², coefficients of media in 1/m, all per RGB channel. Any unit of length gives the same image where the
largest coordinate of shapes, lights and camera lies between 1e-10 and 1e12; other scenes are refused.

## Transforms

`<translate x="" y="" z=""/>`, `<rotate x="" y="" z="" angle=""/>` (counter-clockwise about the axis),
`<scale x="" y="" z=""/>` or `<scale value=""/>`, `<lookat origin="" target="" up=""/>` and `<matrix value=""/>`
(16 numbers, row by row). They multiply from the left in order: the first one written is applied first. The
world is right-handed. Singular transforms are refused.

## Objects, ids and references

An object is `<category type="…" id="…" name="…">`. `<ref id="…"/>` is the object with that id, wherever
in the file it is defined; `name` on the reference says what it is used for, as in
`<ref name="interior" id="smoke"/>`. `<alias id="…" as="…"/>` gives a second id.

- A **shape** holds a `bsdf`, an `emitter` of type `area`, and media named `interior` and `exterior`. Without a
  BSDF it is diffuse with reflectance 0.5, or black when it emits. Inside several shapes at once, the medium of
  the one declared last counts. Media that are written alike are one medium.
- A **sensor** holds a `film` (with its `rfilter`), a `sampler`, and the `medium` around it where the shapes
  do not name it.
- An **emitter** may hold the `medium` around it in the same way.
- The camera looks along its +Z axis with +Y up, and **+X points to the left of the picture**.

## Files, parameters, the command line

- `<include filename="…"/>` reads the elements of another file, found relative to the one that includes it.
- `<path value="folder"/>` adds a folder in which files are looked up.
- `<default name="size" value="512"/>` defines a parameter; `$size` in any later attribute is its value.
- `-D size=64` on the command line overrides the default. A `-D` that nothing uses is an error.
- `-D film.width=64` sets a parameter without the file's help: the words before the last dot choose an element by
  id, tag or type, the last word is the parameter. `-D integrator.type=volpath` changes a type. `emitter:2` is the
  second of several. A transform is 16 numbers, or 9: origin, target and up, as in `-D 'sensor.to_world=0 1 5 0 1 0 0 1 0'`.

## Files of version 0.x

Where `<scene version="…">` is below 2, names in camelCase are converted (`toWorld` is `to_world`, `intIOR` is
`int_ior`), `lookAt` is `lookat`, textures' `uscale` and `uoffset` become `to_uv`, `ldrfilm` becomes `hdrfilm`,
samplers become `sobol`, `<srgb>` is decoded, `diffuseReflectance` of a diffuse BSDF is its `reflectance`, and a
shape with a medium but no BSDF is the bare boundary of that medium.

Of renderers that read this language with additions: `<mode>` and `<hide>` (Rainbow: final picture or preview, and
what its author switched off) are left out with a note, and so are `sampleNum` and `delta` of integrators (Rainbow:
`sample_count` or `--passes` say how many samples), `version` (lajolla: which of its estimators of one picture) and
`subdiv` of spheres.

## glTF scenes

Every command that takes a scene takes glTF 2.0 as well, `.gltf` or `.glb`; `mote convert scene.gltf scene.xml` writes
what it is taken for, in this language, and meshes and pictures into `scene_files` beside it. Both give the same picture to
the bit, and Mitsuba reads the XML after `sobol` became `independent`. Lines in messages ("scene.gltf as XML:57") are those of
that file.

| glTF | here |
|---|---|
| camera | the first one, or `-D camera=NAME`; without one, a view of everything, with a note. 576 pixels high, as wide as the camera says; 64 passes |
| integrator | `path`; `volpath` where there are holes, panes or media: Mitsuba's `path` lets no shadow ray through the first two |
| `KHR_lights_punctual` | `point`, `spot`, `directional`; candela and lux over 683 lm/W. A spot falls off linearly in the angle from the inner to the outer cone; `range` is ignored |
| emissive factor, texture, strength | `area`; cd/m² over 683 lm/W, times `-D emission=FACTOR`. A double-sided lamp that is open is two sheets, 1e-5 of its coordinates apart |
| no light at all | `constant` of radiance 1, with a note |
| metallic-roughness | `principled`; factors are multiplied into new pictures where there is a texture |
| colours of vertices | `mesh_attribute` |
| normal texture, its scale | `normalmap`; parts that show the picture mirrored, and nodes that mirror, get one with green turned over |
| `MASK`, `BLEND` | `mask`; a cutoff is applied to the texels, before they are interpolated |
| `doubleSided` | `twosided`; else a surface is black from behind |
| `KHR_materials_transmission` | with `KHR_materials_volume` glass (`principled` and an absorbing medium inside); without, a thin sheet: `principledthin`, or where it is smooth and clear `thindielectric` |
| `KHR_materials_ior`, `KHR_texture_transform` | `eta`, `to_uv` |
| `KHR_materials_unlit` | `diffuse`, with a note |
| a mesh of many nodes | `shapegroup` and `instance`; copies where it emits light |
| occlusion texture, animations | ignored: shadows are computed, and everything stands as it is stored |

Blender's exporter writes lamps in watts times 683 lm/W, but the strength of an emissive surface as it is; the two fit
together again with `-D emission=683`.

Errors, which `--lenient` turns into a line of what was left out: clearcoat, sheen, specular, iridescence, anisotropy and
dispersion where they are switched on; light from a surface with holes; textures with different sets of coordinates, or
wrapped differently along u and v; a texture and colours of vertices at once; skins, shape keys, compressed meshes,
pictures other than PNG and JPEG, and unknown extensions that the file requires.

## pbrt scenes

Every command that takes a scene takes pbrt-v4 as well, `.pbrt` or `.pbrt.gz`; `mote convert scene.pbrt scene.xml` writes it in
this language. The world keeps its coordinates; the camera mirrors x. An unknown directive, type, name or parameter is an error with file,
line and the nearest known name, and so is what has no counterpart; `--lenient` puts what the table says, or nothing, in its place.

| pbrt | here |
|---|---|
| `Include`, `Import`, gzip | read, 32 deep; files are found beside the scene |
| `Attribute`, transforms, `CoordinateSystem`, `ReverseOrientation`, `ColorSpace` | as in pbrt; `Option` and `Accelerator` are ignored |
| `ActiveTransform EndTime` | an error where it moves a shape; it stands as at the shutter's opening |
| `ObjectBegin`, `ObjectInstance` | `shapegroup`, `instance`; area lights in them emit nothing, as in pbrt |
| `sphere`, `disk`, `cylinder` | exact; cut off or deformed ones are meshes |
| `trianglemesh`, `plymesh` (`.ply.gz`), `bilinearmesh`, `loopsubdiv` | `ply`; patches that are no parallelogram are 8 x 8 squares |
| `curve` | `bsplinecurve`: round tubes; `ribbon` is an error |
| spectra | linear sRGB through the CIE matching functions (the fit errs by less than 0.005 in chromaticity); names of illuminants, metals and glasses; no dispersion |
| `scale`, `power`, `illuminance` | as pbrt normalizes them; exposure time and `iso` are a factor on all lights |
| `point`, `distant`, `spot`, `infinite` | `point`, `directional`, `spot` (falls off linearly in the angle), `constant`, `envmap` (the equal-area picture resampled; portals are ignored) |
| `projection`, `goniometric` | `projector`; an error, the mean intensity as a `point` |
| area light `diffuse`, `twosided` | `area`; two sheets 1e-5 of the coordinates apart |
| `diffuse`, `coateddiffuse`, `conductor`, `dielectric`, `thindielectric`, `mix`, `interface` | `diffuse`, `plastic` or `roughplastic`, `conductor`, `dielectric` and their rough ones of GGX, `thindielectric`, `blendbsdf`, `null`; all but glass `twosided`; alpha is the root of roughness unless `remaproughness` is off |
| `coatedconductor`, `diffusetransmission`, `subsurface`, `hair`, `measured` | errors; the metal, `principledthin`, a coated diffuse, a diffuse of its colour, grey |
| `alpha`, `displacement`, `normalmap` | `mask`, `bumpmap`, `normalmap` |
| `imagemap`, `checkerboard`, `constant` | `bitmap`, `checkerboard`, a colour; `scale`, `mix`, `bilerp`, gamma and inversion are multiplied into new pictures |
| `dots`, `directionmix`, `fbm`, `wrinkled`, `windy`, `marble`, `ptex`, mappings other than uv | errors; regular dots, the mean |
| media `homogeneous`, `uniformgrid`, `rgbgrid`, `nanovdb`, `cloud` | `homogeneous`, `heterogeneous`: `.vol` grids (a cloud of 128^3 voxels), `.nvdb` as it is |
| `perspective`, `orthographic` | `perspective` or `thinlens`, `orthographic`; a window off the axis, `spherical` and `realistic` are errors |
| `Film`, `PixelFilter`, `Sampler` | size, `box`, `tent`, `gaussian` (for others too), number of samples; films are not cropped |
| `path`, `volpath` and others that make the same picture | `path`, `volpath`; `max_depth` is one more |

## What is ours

Types and parameters that Mitsuba lacks: volumes of type `vdbvolume`; the parameters `Le`, `Lescale`,
`temperature`, `temperature_scale` and `temperature_offset` of media that emit; `scale` of area lights; the sampler `sobol`; integrators
whose type begins with `mote_`. A file shared by both renderers holds none of them; the integrator can be chosen
on the command line.
)";

std::string heading(Category category) {
    switch (category) {
        case Category::bsdf:
            return "BSDFs";
        case Category::texture:
            return "Textures";
        case Category::shape:
            return "Shapes";
        case Category::emitter:
            return "Emitters";
        case Category::sensor:
            return "Sensors";
        case Category::film:
            return "Film";
        case Category::rfilter:
            return "Reconstruction filters";
        case Category::sampler:
            return "Samplers";
        case Category::medium:
            return "Media";
        case Category::phase:
            return "Phase functions";
        case Category::volume:
            return "Volumes";
        case Category::integrator:
            return "Integrators";
        case Category::compensation:
            return "Compensation of the bound";
        case Category::visibility:
            return "Visibility";
        case Category::selection:
            return "Selection of virtual point lights";
    }
    return "";
}

/// A cell of a table: a bar would end it.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
    return result.empty() ? " " : result;
}

std::string page(const Manual& manual) {
    std::string text = "\n### `" + manual.type + "`\n\n" + manual.summary + "\n";
    if (!manual.parameters.empty()) {
        text += "\n| parameter | type | default | values | meaning |\n|---|---|---|---|---|\n";
        for (const Parameter& p : manual.parameters)
            text += "| `" + p.name + "` | " + p.type + " | " + cell(p.default_value) + " | " +
                    cell(values_text(p)) + " | " + cell(p.description) + " |\n";
    }
    return text + "\n```xml\n" + manual.example + "\n```\n";
}

}  // namespace

std::string scene_format_markdown(const Registry& registry) {
    std::string text = introduction + mitsuba_features_markdown(registry);
    for (int c = 0; c < category_count; ++c) {
        const auto category = Category(c);
        const std::vector<std::string> types = registry.types(category);
        if (types.empty()) continue;
        text += "\n## " + heading(category) + "\n";
        for (const std::string& type : types) text += page(*registry.find(category, type));
    }
    return text;
}

}  // namespace mote::core
