"""A live render of an exported scene: `mote view` as a child process, its images by WebSocket."""
import subprocess
import threading

import numpy as np

from .live_socket import WebSocket, parsed


class LiveView:
    """The last image of a scene that is rendered while its camera moves. changed() is called in a thread for each."""

    def __init__(self, program, scene, options, changed):
        self.image, self.problem, self.finished, self.changed = None, "", False, changed
        self.process = subprocess.Popen([program, "view", str(scene), *options, "--no-browser"], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        url = self.process.stdout.readline().strip()
        if not url.startswith("http://"):
            self.process.wait()
            raise RuntimeError(f"mote view ended: {self.process.stderr.read().strip()}")
        self.socket = WebSocket(url.replace("http:", "ws:") + "socket", timeout=None)
        self.socket.send({"type": "hello"})
        self.thread = threading.Thread(target=self.receive, daemon=True)
        self.thread.start()

    def receive(self):
        try:
            while True:
                header, payload = parsed(self.socket.receive())
                if header["type"] == "frame":
                    self.take(header, payload)
                elif header["type"] == "problem":
                    self.problem = header["text"]
                    self.changed()
        except (OSError, ValueError):  # closed
            pass

    def take(self, header, payload):
        """The beauty is the first layer."""
        self.socket.send({"type": "got", "picture": header["picture"]})
        size = header["height"], header["width"], 3
        pixels = np.frombuffer(payload, "<f2", size[0] * size[1] * 3).astype(np.float32).reshape(size)
        self.image, self.finished, self.problem = header["scale"] * pixels, header["finished"], ""
        self.changed()

    def move(self, origin, target, up):
        self.finished = False
        self.socket.send({"type": "camera", "view": [*origin, *target, *up]})

    def close(self):
        self.process.terminate()
        self.socket.close()
        self.process.wait()
