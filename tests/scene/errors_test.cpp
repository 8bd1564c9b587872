// Malformed scenes: every message is asserted whole, after its exit code.
#include <filesystem>
#include <fstream>
#include <vector>

#include "reading.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

struct Malformed {
  std::string content;   ///< of the scene, from line 2 of test.xml
  std::string expected;  ///< exit code and message
};

class MalformedScene : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedScene, IsRefusedWithAMessage) { EXPECT_EQ(load_complaint(GetParam().content), GetParam().expected); }

// How the text is built.
INSTANTIATE_TEST_SUITE_P(
    Text, MalformedScene,
    ::testing::Values(
        Malformed{"<shape type=\"sphere\">",
                  "3 test.xml:3:3: this is not well-formed XML: this does not close the tag that is open here"},
        Malformed{"<shape type=sphere/>",
                  "3 test.xml:2:13: this is not well-formed XML: error parsing element attribute"},
        Malformed{"<shape type=\"sphere\"",
                  "3 test.xml:3:1: this is not well-formed XML: error parsing start element tag"},
        Malformed{"hello", "3 test.xml:1:1: <scene> cannot contain text: values are written in attributes"},
        Malformed{"<shaep type=\"sphere\"/>", "3 test.xml:2:1: unknown tag <shaep>, did you mean 'shape'?"},
        Malformed{"<scene version=\"3.0.0\"/>", "3 test.xml:2:1: <scene> can only be the root"},
        Malformed{"<shape type=\"sphere\" tpye=\"x\"/>",
                  "3 test.xml:2:1: unknown attribute 'tpye' of <shape>, did you mean 'type'?"},
        Malformed{"<shape id=\"ball\"/>", "3 test.xml:2:1: <shape> needs the attribute 'type'"},
        Malformed{"<translate x=\"1\"/>", "3 test.xml:2:1: <translate> can only stand inside <transform>"},
        Malformed{"<shape type=\"sphere\">\n<float name=\"radius\" value=\"1\"><float name=\"r\" "
                  "value=\"2\"/></float></shape>",
                  "3 test.xml:3:32: <float> cannot stand inside <float>"},
        Malformed{"<shape type=\"sphere\"><path value=\".\"/></shape>",
                  "3 test.xml:2:22: <path> can only stand directly inside <scene>"},
        Malformed{"<path value=\"no/such/folder\"/>", "3 test.xml:2:14: there is no folder 'no/such/folder'"},
        Malformed{"<shape type=\"$kind\"/>", "3 test.xml:2:14: undefined variable $kind"},
        Malformed{"<default name=\"resolution\" value=\"3\"/><shape type=\"sphere\"><float name=\"radius\" "
                  "value=\"$resolutoin\"/></shape>",
                  "3 test.xml:2:88: undefined variable $resolutoin, did you mean 'resolution'?"},
        Malformed{"<default name=\"\" value=\"3\"/>", "3 test.xml:2:1: <default> needs a name that is not empty"}));

// Values.
INSTANTIATE_TEST_SUITE_P(
    Value, MalformedScene,
    ::testing::Values(
        Malformed{"<shape type=\"sphere\"><float name=\"radius\" value=\"1.0x\"/></shape>",
                  "3 test.xml:2:50: '1.0x' is not a number"},
        Malformed{"<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>",
                  "3 test.xml:2:50: 'nan' is not a finite number"},
        Malformed{"<shape type=\"sphere\"><float name=\"radius\" value=\"1e300\"/></shape>",
                  "3 test.xml:2:50: '1e300' is not a finite number"},
        Malformed{"<shape type=\"sphere\"><point name=\"center\" value=\"1 2\"/></shape>",
                  "3 test.xml:2:50: expected 1 or 3 numbers, found 2"},
        Malformed{"<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\"/></shape>",
                  "3 test.xml:2:22: <point> needs the attribute 'z'"},
        Malformed{"<shape type=\"sphere\"><point name=\"center\" value=\"1\" x=\"2\"/></shape>",
                  "3 test.xml:2:22: <point> takes either 'value' or 'x', 'y', 'z'"},
        Malformed{"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.1 0.2\"/></bsdf>",
                  "3 test.xml:2:53: expected 1 or 3 numbers, found 2"},
        Malformed{"<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"#12345\"/></bsdf>",
                  "3 test.xml:2:53: '#12345' is not a colour, expected #rrggbb or one or three numbers"},
        Malformed{"<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:0.1, 0.2\"/></bsdf>",
                  "3 test.xml:2:58: '0.2' is not a wavelength:value pair (<rgb> takes three numbers)"},
        Malformed{"<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"500:0.1, 400:0.2\"/></bsdf>",
                  "3 test.xml:2:58: wavelengths must increase, found 500 before 400"},
        Malformed{"<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"none.spd\"/></bsdf>",
                  "3 test.xml:2:61: there is no file 'none.spd' (looked in: .)"},
        Malformed{"<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"yes\"/></shape>",
                  "3 test.xml:2:56: 'yes' is not a boolean, expected true or false"},
        Malformed{"<sampler type=\"independent\"><integer name=\"sample_count\" value=\"1.5\"/></sampler>",
                  "3 test.xml:2:65: '1.5' is not an integer"},
        Malformed{"<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 2 3\"/></transform></shape>",
                  "3 test.xml:2:62: expected 16 or 9 numbers, found 3"},
        Malformed{"<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1 0 1\"/></transform></shape>",
                  "3 test.xml:2:47: the transform is singular: it has no inverse"},
        Malformed{"<shape type=\"cube\"><transform name=\"to_world\"><rotate x=\"0\" angle=\"9\"/></transform></shape>",
                  "3 test.xml:2:47: a rotation needs an axis other than zero"},
        Malformed{"<shape type=\"cube\"><transform name=\"to_world\"><lookat origin=\"1,1,1\" target=\"1,1,1\" "
                  "up=\"0,1,0\"/></transform></shape>",
                  "3 test.xml:2:47: lookat: origin and target are the same point"},
        Malformed{"<shape type=\"cube\"><transform name=\"to_world\"><rotated x=\"1\"/></transform></shape>",
                  "3 test.xml:2:47: <rotated> cannot stand inside <transform>, did you mean 'rotate'?"},
        Malformed{
            "<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/>\n<float name=\"radius\" value=\"2\"/></shape>",
            "3 test.xml:3:1: 'radius' is given twice, first in line 2"}));

// Names.
INSTANTIATE_TEST_SUITE_P(
    Name, MalformedScene,
    ::testing::Values(
        Malformed{"<shape type=\"sphre\"/>", "3 test.xml:2:1: unknown shape 'sphre', did you mean 'sphere'?"},
        Malformed{"<shape type=\"xyzzy\"/>", "3 test.xml:2:1: unknown shape 'xyzzy'"},
        Malformed{"<medium type=\"heterogenous\"/>",
                  "3 test.xml:2:1: unknown medium 'heterogenous', did you mean 'heterogeneous'?"},
        Malformed{"<bsdf type=\"diffuse\"><rgb name=\"reflectence\" value=\"0.5\"/></bsdf>",
                  "3 test.xml:2:33: unknown parameter of bsdf 'diffuse': 'reflectence', did you mean 'reflectance'?"},
        Malformed{
            "<bsdf type=\"plastic\">\n<float name=\"int_iro\" value=\"1.5\"/>\n<float name=\"gloss\" "
            "value=\"1\"/>\n<shape type=\"cube\"/></bsdf>",
            "3 test.xml:3:14: unknown parameters of bsdf 'plastic': 'int_iro', did you mean 'int_ior'?; 'gloss' in "
            "line 4 (expected one of: int_ior, ext_ior, diffuse_reflectance, nonlinear, specular_reflectance); a shape "
            "without a name in line 5"},
        Malformed{"<float name=\"stray\" value=\"1\"/>",
                  "3 test.xml:2:14: unknown parameter of the scene: 'stray' (it has none)"},
        Malformed{"<bsdf type=\"null\"><float name=\"a\" value=\"1\"/></bsdf>",
                  "3 test.xml:2:32: unknown parameter of bsdf 'null': 'a' (it has none)"},
        Malformed{"<shape type=\"obj\"/>",
                  "3 test.xml:2:1: shape 'obj' needs the parameter 'filename' (a string that names a file: the mesh)"},
        Malformed{"<shape type=\"sphere\"><string name=\"radius\" value=\"big\"/></shape>",
                  "3 test.xml:2:51: 'radius' of shape 'sphere' expects a float, found a string"},
        Malformed{"<bsdf type=\"roughdielectric\"><string name=\"distribution\" value=\"gxx\"/></bsdf>",
                  "3 test.xml:2:65: 'distribution' of bsdf 'roughdielectric' cannot be 'gxx', did you mean 'ggx'?"},
        Malformed{
            "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"watr\"/></bsdf>",
            "3 test.xml:2:55: 'int_ior' of bsdf 'dielectric' names the unknown material 'watr', did you mean 'water'?"},
        Malformed{"<bsdf type=\"conductor\"><string name=\"material\" value=\"Unobtainium\"/></bsdf>",
                  "3 test.xml:2:55: 'material' of bsdf 'conductor' names the unknown metal 'Unobtainium'"},
        Malformed{"<medium type=\"homogeneous\"><string name=\"material\" value=\"Kechup\"/></medium>",
                  "3 test.xml:2:59: 'material' of medium 'homogeneous' names the unknown material 'Kechup', did you "
                  "mean 'Ketchup'?"},
        Malformed{"<shape type=\"cube\"><medium type=\"homogeneous\"/></shape>",
                  "3 test.xml:2:20: unknown parameter of shape 'cube': a medium without a name (expected one of: "
                  "interior, exterior)"},
        Malformed{"<bsdf type=\"twosided\"><bsdf type=\"dielectric\"/></bsdf>",
                  "3 test.xml:2:1: bsdf 'twosided': only materials without transmission can be two-sided"},
        Malformed{"<bsdf type=\"mask\"/>",
                  "3 test.xml:2:1: bsdf 'mask' needs the parameter 'bsdf' (a bsdf: the material)"}));

// References.
INSTANTIATE_TEST_SUITE_P(
    Reference, MalformedScene,
    ::testing::Values(
        Malformed{"<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>",
                  "3 test.xml:3:1: the id 'a' is already used at test.xml:2:1"},
        Malformed{"<bsdf type=\"diffuse\" id=\"white\"/>\n<shape type=\"cube\"><ref id=\"whit\"/></shape>",
                  "3 test.xml:3:20: there is nothing with the id 'whit', did you mean 'white'?"},
        Malformed{
            "<bsdf type=\"mask\" id=\"a\"><ref id=\"b\"/></bsdf>\n<bsdf type=\"mask\" id=\"b\"><ref id=\"a\"/></bsdf>",
            "3 test.xml:3:26: cyclic reference: 'b' -> 'a' leads back to bsdf 'mask' around it"},
        Malformed{"<bsdf type=\"mask\" id=\"a\"><ref id=\"a\"/></bsdf>",
                  "3 test.xml:2:26: cyclic reference: 'a' leads back to bsdf 'mask' around it"},
        Malformed{"<bsdf type=\"mask\" id=\"a\"><bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf></bsdf><shape "
                  "type=\"cube\"><ref id=\"b\"/></shape>",
                  "3 test.xml:2:55: cyclic reference: 'a' leads back to bsdf 'mask' around it"},
        Malformed{"<alias id=\"a\" as=\"b\"/><alias id=\"b\" as=\"a\"/>",
                  "3 test.xml:2:23: the alias 'a' refers to itself"},
        Malformed{"<alias id=\"nothing\" as=\"b\"/>",
                  "3 test.xml:2:1: there is nothing with the id 'nothing' (expected one of: b)"}));

// Physics.
INSTANTIATE_TEST_SUITE_P(
    Physics, MalformedScene,
    ::testing::Values(
        Malformed{"<medium type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"1 -1 1\"/></medium>",
                  "3 test.xml:2:55: 'sigma_t' of medium 'homogeneous' is (1, -1, 1), expected numbers at least 0"},
        Malformed{"<medium type=\"homogeneous\"><rgb name=\"albedo\" value=\"0.9 1.01 0.9\"/></medium>",
                  "3 test.xml:2:54: 'albedo' of medium 'homogeneous' is (0.9, 1.01, 0.9), expected numbers in [0, 1]"},
        Malformed{"<medium type=\"homogeneous\">\n<float name=\"sigma_s\" value=\"-2\"/></medium>",
                  "3 test.xml:3:30: 'sigma_s' of medium 'homogeneous' is -2, expected a number at least 0"},
        Malformed{"<medium type=\"homogeneous\"><float name=\"sigma_s\" value=\"2\"/><float name=\"albedo\" "
                  "value=\"1\"/></medium>",
                  "3 test.xml:2:89: 'albedo' of medium 'homogeneous' cannot stand beside 'sigma_s'"},
        Malformed{"<medium type=\"homogeneous\"><string name=\"material\" value=\"Ketchup\"/><float name=\"sigma_t\" "
                  "value=\"1\"/></medium>",
                  "3 test.xml:2:98: 'sigma_t' of medium 'homogeneous' cannot stand beside 'material'"},
        Malformed{"<medium type=\"homogeneous\"><volume name=\"albedo\" type=\"constvolume\"><float name=\"value\" "
                  "value=\"2\"/></volume></medium>",
                  "3 test.xml:2:28: 'albedo' of medium 'homogeneous' is (2, 2, 2), expected numbers in [0, 1]"},
        Malformed{"<medium type=\"homogeneous\"><volume name=\"albedo\" type=\"gridvolume\"/></medium>",
                  "3 test.xml:2:28: volume 'gridvolume' needs the parameter 'filename' (a string that names a file: "
                  "version 3; "
                  "float32, float16 or uint8; 1 or 3 channels)"},
        Malformed{"<phase type=\"hg\"><float name=\"g\" value=\"1\"/></phase>",
                  "3 test.xml:2:41: 'g' of phase 'hg' is 1, expected a number in (-1, 1)"},
        Malformed{"<phase type=\"tabphase\"><string name=\"values\" value=\"1, -1\"/></phase>",
                  "3 test.xml:2:1: phase 'tabphase': a value of a tabulated phase function is negative or not finite"},
        Malformed{"<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"1.5\"/></bsdf>",
                  "3 test.xml:2:55: 'reflectance' of bsdf 'diffuse' is 1.5, expected a number in [0, 1]"},
        Malformed{"<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"0\"/></bsdf>",
                  "3 test.xml:2:54: 'int_ior' of bsdf 'dielectric' is 0, expected a number above 0"},
        Malformed{"<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>",
                  "3 test.xml:2:50: 'radius' of shape 'sphere' is 0, expected a number above 0"},
        Malformed{"<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
                  "3 test.xml:2:1: shape 'sphere': to_world must be a rotation, translation and uniform scale only"},
        Malformed{"<shape type=\"cube\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"-1\"/></emitter></shape>",
                  "3 test.xml:2:69: 'radiance' of emitter 'area' is (-1, -1, -1), expected numbers at least 0"},
        Malformed{"<shape type=\"cube\"><emitter type=\"point\"/></shape>",
                  "3 test.xml:2:20: emitter 'point' cannot stand inside a shape, only 'area' can"},
        Malformed{"<emitter type=\"area\"/>", "3 test.xml:2:1: emitter 'area' must stand inside the shape that shines"},
        Malformed{"<emitter type=\"constant\"/>\n<emitter type=\"constant\"/>",
                  "3 test.xml:3:1: a scene can have one environment, found emitter 'constant' after emitter 'constant' "
                  "in line 2"},
        Malformed{
            "<integrator type=\"path\"/>\n<integrator type=\"volpath\"/>",
            "3 test.xml:3:1: a scene has one integrator, found integrator 'volpath' after integrator 'path' in line 2"},
        Malformed{"<integrator type=\"path\"><string name=\"scene_unit\" value=\"inch\"/></integrator>",
                  "3 test.xml:2:58: 'inch' is not a length, expected um, mm, cm, dm, m, km or a number of metres"},
        Malformed{"<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor>",
                  "3 test.xml:2:53: 'fov' of sensor 'perspective' is 180, expected a number in (0, 180)"},
        Malformed{
            "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"0\"/></film></sensor>",
            "3 test.xml:2:78: 'width' of film 'hdrfilm' is 0, expected a number in [1, 1048576]"},
        Malformed{"<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"crop_width\" "
                  "value=\"800\"/></film></sensor>",
                  "3 test.xml:2:28: the crop window does not lie inside the film"},
        Malformed{"<sensor type=\"perspective\"><film type=\"hdrfilm\"><float name=\"outlier_base\" "
                  "value=\"1\"/></film></sensor>",
                  "3 test.xml:2:83: 'outlier_base' of film 'hdrfilm' is 1, expected a number in [2, 64]"},
        Malformed{"<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"lanczos\"/></film></sensor>",
                  "3 test.xml:2:49: rfilter 'lanczos' is not supported"}));

}  // namespace
}  // namespace turbid::testing
