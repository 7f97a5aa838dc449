"""The viewer's page in a real browser: start, first picture, layers, difference, flip, knobs, camera, a pixel, stop,
save; and what was saved against `mote render`. Prints LEFT OUT where there is no chromium.

Usage: page_test.py MOTE SCENE [FOLDER for screenshots]
"""
import base64
import json
import os
import sys
import tempfile
import time

import browser
from reproduced import same_bits
from view_program import Program

mote, scene = (os.path.abspath(path) for path in sys.argv[1:3])
shots = sys.argv[3] if len(sys.argv) > 3 else tempfile.mkdtemp()
if not browser.find():
    print("LEFT OUT: no chromium (tools/install_packages.sh --browser installs it)")
    sys.exit(0)

PIXELS = """(() => { const v = moteView, gl = v.image.gl, { width, height } = v.canvas;
  const data = new Uint8Array(4 * width * height);
  v.draw();
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
  let sum = 0;
  for (let i = 0; i < data.length; i += 4) sum = (sum * 31 + data[i] + 256 * data[i + 1] + 65536 * data[i + 2]) % 1000000007;
  return sum; })()"""


def check(holds, what):
    print(("ok      " if holds else "FAILED  ") + what, flush=True)
    if not holds:
        sys.exit(1)


def saved_picture(page):
    """The bytes of the file that the page received."""
    page.evaluate("moteView.saved = null")
    page.evaluate("[...document.querySelectorAll('button')].find((b) => b.textContent === 'EXR').click()")
    page.wait("moteView.saved")
    text = page.evaluate("""new Promise((done) => { const r = new FileReader();
        r.onload = () => done(r.result); r.readAsDataURL(moteView.saved.blob); })""")
    return base64.b64decode(text.split(",", 1)[1])


def check_bits(page, folder, what):
    """The saved picture against the command that the page prints."""
    page.evaluate("moteView.reproduced = null; moteView.send({type: 'reproduce', picture: 'A'})")
    command = page.wait("moteView.reproduced && moteView.reproduced.command")
    check(same_bits(mote, command, saved_picture(page), folder), f"{what}: the saved picture has the bits of {command}")


def points_and_cuts(page):
    """VPLs over the image, the cut of a selection, and photons."""
    page.evaluate("moteView.pointsInput.click()")
    page.wait("moteView.points")
    check(page.evaluate("moteView.points.points.length") > 10, page.evaluate("moteView.pointsText.textContent"))
    for define, kind in (({"integrator.selection": "lightcuts", "integrator.paths": "2000"}, "VPL"), (None, "photon")):
        message = {"type": "set", "define": define} if define else {"type": "set", "integrator": "mote_photon_map"}
        page.evaluate(f"moteView.send({json.dumps(message)})")
        page.wait(f"moteView.points && moteView.points.kind === '{kind}'")
        page.evaluate("moteView.light = null; moteView.askPixel(70, 80)")
        light = page.wait("moteView.light && moteView.light.light")
        total = [sum(s["light"][i] for s in light["sources"]) for i in range(3)]
        check(light["kind"] == kind and light["lit_by"] > 0 and all(a <= b * 1.0001 for a, b in zip(total, light["sum"])),
              f"{light['facts']}: {light['lit_by']} of {light['connected']} light the pixel")
        if define:
            check(any(s["cluster"] > 1 for s in light["sources"]), "clusters of the tile's cut")
        page.screenshot(os.path.join(shots, f"{kind}.png"))
    page.evaluate("moteView.pointsInput.click()")
    page.evaluate("moteView.send({type: 'set', integrator: 'mote_vpl'})")


def main():
    start = time.monotonic()
    with Program(mote, scene, "-D", "film.width=160", "-D", "film.height=100", "--integrator", "mote_vpl", "-D",
                 "integrator.paths=32", "--passes", "40") as program, \
            browser.Browser(program.url) as page, tempfile.TemporaryDirectory() as folder:
        page.wait("window.moteView && moteView.pictures.size > 0")
        print(f"        first picture in the page {time.monotonic() - start:.2f} s after the start of program and browser")
        page.wait("moteView.picture('A').finished")
        names = page.evaluate("moteView.picture('A').layers.map((l) => l.name)")
        check("direct" in names and "indirect_bounded" in names, f"layers arrive: {', '.join(names)}")
        whole = page.evaluate(PIXELS)
        check(page.evaluate("moteView.picture('A').passes") == 40, "all passes are in the picture")

        took = page.evaluate("""(() => { const t = performance.now();
            document.querySelector('[data-layer=direct]').click();
            moteView.image.gl.finish(); return performance.now() - t; })()""")
        without = page.evaluate(PIXELS)
        check(without != whole and took < 50, f"a layer is taken out of the sum, in {took:.1f} ms")
        page.click("[data-layer=direct]")
        check(page.evaluate(PIXELS) == whole, "and put back: the same pixels")
        page.click("[data-alone=direct]")
        check(page.evaluate(PIXELS) not in (whole, without), "a layer alone")
        page.click("[data-alone=direct]")

        page.evaluate("""(() => { const s = document.querySelector('[data-knob=second]');
            s.value = 'path'; s.dispatchEvent(new Event('change')); })()""")
        page.wait("moteView.picture('B') && moteView.picture('B').finished && moteView.picture('A').finished", 120)
        first = page.evaluate(PIXELS)
        page.press("f")
        flipped = page.evaluate(PIXELS)
        check(page.evaluate("moteView.shown") == "B" and flipped != first, "F flips to the second method")
        page.press("f")
        check(page.evaluate(PIXELS) == first, "and back")
        page.evaluate("moteView.modeInput.value = '2'; moteView.modeInput.dispatchEvent(new Event('change'))")
        check(page.evaluate(PIXELS) != first, "signed difference")
        page.screenshot(os.path.join(shots, "difference.png"))
        page.evaluate("moteView.modeInput.value = '0'; moteView.modeInput.dispatchEvent(new Event('change'))")
        page.evaluate("moteView.splitButton.click()")
        check(page.evaluate(PIXELS) not in (first, flipped), "split")
        page.evaluate("moteView.splitButton.click()")
        page.evaluate("""(() => { const s = document.querySelector('[data-knob=second]');
            s.value = ''; s.dispatchEvent(new Event('change')); })()""")
        page.wait("!moteView.picture('B')")

        page.evaluate("""(() => { const i = document.querySelector('[data-knob="integrator.paths"]');
            i.value = '64'; i.dispatchEvent(new Event('change')); })()""")
        page.wait("moteView.scene.pictures[0].changes.defines['integrator.paths'] === '64'")
        page.wait("moteView.picture('A').finished && moteView.picture('A').passes === 40", 120)
        check(page.evaluate(PIXELS) != whole, "a knob of the integrator changes the picture")
        check_bits(page, folder, "integrator")
        before = page.evaluate("moteView.statistics.frames")
        page.evaluate("document.querySelector('[data-twice=\"emitter:1.radiance\"]').click()")
        page.wait("moteView.scene.pictures[0].changes.defines['emitter:1.radiance']")
        page.wait(f"moteView.statistics.frames > {before} && moteView.picture('A').finished", 120)

        change = page.evaluate("moteView.lastChange")
        view = page.evaluate("moteView.camera.view")
        page.drag((400, 350), (470, 330))
        page.wait(f"moteView.lastChange > {change} + 3")
        coarse = page.evaluate("moteView.statistics.coarse")
        check(coarse > 3 and page.evaluate("moteView.camera.view") != view, "the camera turns, with coarse pictures")
        page.wait("!moteView.dragging && moteView.picture('A').finished && !moteView.picture('A').coarse", 120)
        check_bits(page, folder, "lights and camera")

        page.mouse("mousePressed", 480, 600, button="left", clickCount=1)
        page.mouse("mouseReleased", 480, 600, button="left", clickCount=1)
        page.wait("moteView.light")
        page.screenshot(os.path.join(shots, "pixel.png"))
        light = page.evaluate("moteView.light.light")
        x, y = page.evaluate("[moteView.light.x, moteView.light.y]")
        listed = next(v for v in page.evaluate("moteView.light.values") if v["layer"] == "beauty")
        shown = page.evaluate(f"moteView.picture('A').value(0, {x}, {y})")
        check(listed["channels"] == ["R", "G", "B"] and
              all(abs(a - b) <= 1e-3 * abs(a) + 1e-6 for a, b in zip(listed["values"], shown)), "its values are those of the picture")
        check(light["kind"] == "VPL" and light["sources"] and light["path"] and light["first"]["depth"] > 0,
              f"a pixel: {light['lit_by']} VPLs light it, {len(light['path'])} vertices on its eye path")
        points_and_cuts(page)

        page.evaluate("moteView.send({type: 'set', passes: 100000})")
        page.wait("moteView.state.A && moteView.state.A.passes > 3 && moteView.state.A.passes_wanted === 100000")
        page.evaluate("moteView.send({type: 'stop'})")
        time.sleep(1.0)
        passes = page.evaluate("moteView.picture('A').passes")
        time.sleep(0.5)
        check(page.evaluate("moteView.picture('A').passes") == passes > 0, f"stop keeps what there is: {passes} passes")
        check_bits(page, folder, "interrupted")
        check(not page.exceptions(), "the page raised no exception")
    print("passed")


main()
