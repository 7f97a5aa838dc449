// Scenes that use much of the language, and the files that they name.
#include <filesystem>
#include <fstream>

#include "core/formats/pictures/image_file.h"
#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

const char* const surfaces = R"(<scene version="3.0.0">
 <default name="size" value="8"/>
 <integrator type="path"><integer name="max_depth" value="4"/></integrator>
 <sensor type="perspective" id="eye">
  <float name="fov" value="45"/>
  <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="$size"/><integer name="height" value="$size"/>
   <rfilter type="tent"/></film>
  <sampler type="independent"><integer name="sample_count" value="4"/></sampler>
 </sensor>
 <bsdf type="diffuse" id="wall"><rgb name="reflectance" value="0.5, 0.4, 0.3"/></bsdf>
 <bsdf type="twosided" id="both"><bsdf type="roughconductor"><string name="material" value="Cu"/>
  <float name="alpha" value="0.2"/></bsdf></bsdf>
 <shape type="rectangle"><ref id="wall"/><transform name="to_world"><rotate x="1" angle="-90"/><scale value="3"/>
  <translate y="-1"/></transform></shape>
 <shape type="sphere"><point name="center" x="0" y="0" z="0"/><float name="radius" value="0.5"/>
  <bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf></shape>
 <shape type="cube"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
  <string name="filename" value="picture.png"/></texture></bsdf></shape>
 <shape type="obj"><string name="filename" value="mesh.obj"/><ref id="both"/></shape>
 <shape type="cylinder"><bsdf type="plastic"/></shape>
 <shape type="disk"><emitter type="area"><rgb name="radiance" value="4, 4, 4"/></emitter></shape>
 <emitter type="point"><point name="position" x="0" y="3" z="0"/><spectrum name="intensity" value="400:1, 700:2"/></emitter>
 <emitter type="spot"><transform name="to_world"><matrix value="1 0 0 0 0 1 0 0 0 0 1 4 0 0 0 1"/></transform></emitter>
 <emitter type="envmap"><string name="filename" value="picture.png"/></emitter>
</scene>)";

const char* const media = R"(<scene version="3.0.0">
 <integrator type="volpath"/>
 <sensor type="thinlens"><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
  <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/></film></sensor>
 <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.5, 0.6, 0.7"/><float name="albedo" value="0.8"/>
  <phase type="hg"><float name="g" value="0.6"/></phase></medium>
 <shape type="cube"><bsdf type="null"/><ref name="interior" id="fog"/></shape>
 <shape type="sphere"><transform name="to_world"><scale value="2"/><translate x="1"/></transform><bsdf type="null"/>
  <medium name="interior" type="heterogeneous"><volume name="sigma_t" type="gridvolume">
   <string name="filename" value="grid.vol"/><boolean name="clamp_negative" value="true"/></volume>
   <float name="scale" value="2"/><phase type="isotropic"/></medium></shape>
 <emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/></emitter>
 <emitter type="constant"><rgb name="radiance" value="0.2"/></emitter>
</scene>)";

const char* const legacy = R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="0.6.0">
 <integrator type="path"><integer name="maxDepth" value="8"/></integrator>
 <sensor type="perspective"><string name="fovAxis" value="smaller"/><float name="fov" value="35"/>
  <transform name="toWorld"><translate x="0" y="0" z="4"/></transform>
  <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/></film></sensor>
 <shape type="sphere"><bsdf type="roughplastic"><float name="intIOR" value="1.5"/><rgb name="diffuseReflectance" value="0.2 0.3 0.4"/></bsdf>
  <emitter type="area"><spectrum name="radiance" value="1"/></emitter></shape>
 <include filename="part.xml"/>
</scene>)";

}  // namespace

std::vector<Bytes> scene_seeds() { return {bytes_of(surfaces), bytes_of(media), bytes_of(legacy)}; }

void write_neighbours(const std::string& folder) {
    const std::filesystem::path root(folder);
    const auto write = [&](const char* name, const Bytes& bytes) {
        std::ofstream(root / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    };
    core::write_png((root / "picture.png").string(), 2, 2, std::vector<core::Rgb>(4, core::Rgb(0.5f)));
    write("mesh.obj", obj_seeds().front());
    write(next_film, partial_film(5, 8));
    write("grid.vol", vol_seeds().front());
    write("part.xml", bytes_of("<scene version=\"0.6.0\"><shape type=\"rectangle\"/></scene>"));
}

}  // namespace mote::fuzz
