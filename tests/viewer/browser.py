"""Debian's chromium without a window, by its debugging protocol."""
import base64
import json
import os
import shutil
import subprocess
import tempfile
import time

from websocket import WebSocket


def find():
    """Path of chromium; None where there is none."""
    return shutil.which("chromium")


class Browser:
    """One page of a browser of its own."""

    def __init__(self, url, width=1280, height=760):
        self.folder = tempfile.mkdtemp(prefix="mote_browser")
        arguments = [find(), "--headless=new", "--remote-debugging-port=0", f"--user-data-dir={self.folder}",
                     "--no-first-run", "--no-default-browser-check", "--disable-gpu", "--enable-unsafe-swiftshader",
                     "--use-angle=swiftshader", "--disable-dev-shm-usage", f"--window-size={width},{height}", "about:blank"]
        if os.geteuid() == 0:
            arguments.insert(1, "--no-sandbox")
        self.log = open(os.path.join(self.folder, "log"), "w", encoding="utf-8")
        self.process = subprocess.Popen(arguments, stdout=self.log, stderr=self.log)
        self.number = 0
        self.messages = []  # of the page's console
        port_file = os.path.join(self.folder, "DevToolsActivePort")
        end = time.monotonic() + 60
        while not (os.path.exists(port_file) and open(port_file, encoding="ascii").read().count("\n") >= 1):
            if time.monotonic() > end or self.process.poll() is not None:
                raise RuntimeError("chromium does not start: " + open(self.log.name, encoding="utf-8").read()[-2000:])
            time.sleep(0.05)
        port, path = open(port_file, encoding="ascii").read().split("\n")[:2]
        self.socket = WebSocket(f"ws://127.0.0.1:{port}{path}")
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = None
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Page.navigate", url=url)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if getattr(self, "session", None):
            message["sessionId"] = self.session
        self.socket.send(message)
        while True:
            answer = json.loads(self.socket.receive()[1])
            if answer.get("method") in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled"):
                self.messages.append(answer["params"])
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def evaluate(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, script, seconds=60.0):
        """Until the script's value is true; returns it."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = self.evaluate(script)
            if value:
                return value
            time.sleep(0.02)
        raise TimeoutError(f"{script} was never true; console: {self.messages[-3:]}")

    def click(self, selector):
        self.evaluate(f"document.querySelector({json.dumps(selector)}).click()")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start, end, steps=10, pause=0.05):
        self.mouse("mousePressed", *start, button="left", clickCount=1)
        for i in range(1, steps + 1):
            at = [start[k] + (end[k] - start[k]) * i / steps for k in (0, 1)]
            self.mouse("mouseMoved", *at, button="left", buttons=1)
            time.sleep(pause)
        self.mouse("mouseReleased", *end, button="left", clickCount=1)

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, text=key if kind == "keyDown" else "")

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def exceptions(self):
        return [m for m in self.messages if "exceptionDetails" in m]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
