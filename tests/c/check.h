/* What the tests of the C interface share: a check that counts, a small scene, a clock. */
#ifndef MOTE_TESTS_C_CHECK_H
#define MOTE_TESTS_C_CHECK_H

#include <stdio.h>
#include <string.h>
#include <time.h>

static int failures = 0, checks = 0;

static void check(int holds, const char* what, int line) {
    ++checks;
    if (holds) return;
    ++failures;
    fprintf(stderr, "line %d: %s\n", line, what);
}
#define CHECK(condition) check((condition) != 0, #condition, __LINE__)

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static const char* const small_scene =
    "<scene version=\"3.0.0\">\n"
    "  <default name=\"paths\" value=\"64\"/>\n"
    "  <integrator type=\"mote_vpl\"><integer name=\"paths\" value=\"$paths\"/></integrator>\n"
    "  <sensor type=\"perspective\">\n"
    "    <float name=\"fov\" value=\"50\"/>\n"
    "    <transform name=\"to_world\"><lookat origin=\"0, 1, 4\" target=\"0, 0.5, 0\" up=\"0, 1, "
    "0\"/></transform>\n"
    "    <film type=\"hdrfilm\"><integer name=\"width\" value=\"40\"/><integer name=\"height\" "
    "value=\"30\"/></film>\n"
    "  </sensor>\n"
    "  <shape type=\"rectangle\">\n"
    "    <transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale value=\"3\"/></transform>\n"
    "  </shape>\n"
    "  <shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0.5\" z=\"0\"/><float name=\"radius\" "
    "value=\"0.5\"/>\n"
    "    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7, 0.3, 0.2\"/></bsdf>\n"
    "  </shape>\n"
    "  <emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"3\" z=\"2\"/>"
    "<rgb name=\"intensity\" value=\"20, 18, 15\"/></emitter>\n"
    "</scene>\n";

#endif
