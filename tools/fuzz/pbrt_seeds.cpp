// A pbrt scene that uses much of what is read.
#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

const char* const pbrt_scene = R"(LookAt 0 1 -6 0 1 0 0 1 0
Camera "perspective" "float fov" [40] "float lensradius" .1 "float focaldistance" 6
Film "rgb" "integer xresolution" 4 "integer yresolution" 3 "float iso" 50
Sampler "stratified" "integer xsamples" 2 PixelFilter "triangle" "float xradius" 1
Integrator "volpath" "integer maxdepth" 3 Option "seed" 3 Accelerator "bvh"
WorldBegin
MakeNamedMedium "fog" "string type" "uniformgrid" "integer nx" 2 "float density" [1 2] "rgb sigma_s" [1 2 3]
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "float roughness" .1
Texture "t" "spectrum" "checkerboard" "float uscale" 2 "rgb tex1" [.5 .2 .1]
Texture "s" "spectrum" "scale" "texture tex" "t" "float scale" .5
Texture "b" "float" "bilerp" "float v00" .2
LightSource "infinite" "spectrum L" [400 1 700 2] "float illuminance" 3
LightSource "spot" "blackbody I" 3000 "point3 from" [0 3 0] "point3 to" [0 0 0] "float power" 10
Attribute "material" "float eta" 1.4
AttributeBegin
 Material "coateddiffuse" "texture reflectance" "s" "texture displacement" "b" # comment
 AreaLightSource "diffuse" "rgb L" [1 2 3] "bool twosided" true
 Rotate 30 0 1 0 Scale 1 2 1 ReverseOrientation
 MediumInterface "fog" ""
 Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "normal N" [0 0 1 0 0 1 0 0 1]
AttributeEnd
ObjectBegin "o"
 NamedMaterial "gold" Shape "sphere" "float zmax" .5
 Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "float width" .1
ObjectEnd
ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 2 0 0 1] CoordinateSystem "here" CoordSysTransform "camera"
ObjectInstance "o"
Shape "loopsubdiv" "integer levels" 1 "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0]
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] Shape "disk" "float radius" 2 Shape "cylinder"
)";

}  // namespace

std::vector<Bytes> pbrt_scene_seeds() { return {bytes_of(pbrt_scene)}; }

}  // namespace mote::fuzz
