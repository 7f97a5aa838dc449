"""Makes the images of the viewer's pages: docs/images/view_*.png.

Usage: make_screenshots.py MOTE SCENES FOLDER
"""
import os
import sys
import tempfile

from PIL import Image

import browser
from view_program import Program

mote, scenes, folder = sys.argv[1:4]


def save(page, name):
    """With 256 colours: small files."""
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, "x.png")
        page.screenshot(path)
        image = Image.open(path).convert("RGB").quantize(256, dither=Image.Dither.FLOYDSTEINBERG)
    image.save(os.path.join(folder, name), optimize=True)
    print(name, os.path.getsize(os.path.join(folder, name)) // 1024, "kB")


def choose(page, knob, value):
    page.evaluate(f"""(() => {{ const s = document.querySelector('[data-knob="{knob}"]');
        s.value = '{value}'; s.dispatchEvent(new Event('change')); }})()""")


def main():
    box = os.path.join(scenes, "cornell_box.xml")
    with Program(mote, box, "--integrator", "mote_vpl", "--passes", "32", "-D", "film.width=320", "-D", "film.height=320") as program, \
            browser.Browser(program.url, 1120, 620) as page:
        page.wait("window.moteView && moteView.picture('A') && moteView.picture('A').finished", 300)
        page.evaluate("document.querySelectorAll('.panel details')[2].open = true; moteView.update()")
        save(page, "view_scene.png")
        place = page.evaluate("moteView.place()")
        at = (place["x"] + 0.30 * place["width"], place["y"] + 0.90 * place["height"])
        for kind in ("mousePressed", "mouseReleased"):
            page.mouse(kind, *at, button="left", clickCount=1)
        page.wait("moteView.light")
        page.evaluate("""document.querySelectorAll('.panel details').forEach((d) => { d.open = d.textContent.startsWith('light of'); });
            moteView.draw()""")
        save(page, "view_pixel.png")
        page.evaluate("document.querySelectorAll('.panel details').forEach((d, i) => { d.open = i < 2 || d.textContent.startsWith('compare'); })")
        choose(page, "second", "mote_bdpt")
        choose(page, "passes", "64")
        page.wait("moteView.picture('B') && moteView.picture('B').finished && moteView.picture('A').finished", 300)
        page.evaluate("moteView.light = null; moteView.setExposure(moteView.display.exposure + 3); moteView.modeInput.value = '2'; moteView.modeInput.dispatchEvent(new Event('change')); moteView.update()")
        save(page, "view_difference.png")


main()
