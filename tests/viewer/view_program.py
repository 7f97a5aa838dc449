"""`mote view` as a child process, and a client of it."""
import subprocess
import time

from websocket import WebSocket, parsed


class Program:
    def __init__(self, mote, *arguments, cwd=None):
        self.process = subprocess.Popen([mote, "view", *arguments, "--no-browser"], stdout=subprocess.PIPE, text=True, cwd=cwd)
        self.url = self.process.stdout.readline().strip()
        if not self.url.startswith("http://"):
            raise RuntimeError(f"mote view printed no address: {self.url!r}")

    def connect(self, **options):
        client = Client(self.url.replace("http:", "ws:") + "socket", **options)
        client.send({"type": "hello"})
        return client

    def is_alive(self):
        return self.process.poll() is None

    def resident_bytes(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()


class Client(WebSocket):
    """Confirms frames, as the page does."""

    def wait_for(self, condition, seconds=60.0):
        """The first (header, payload) for which condition(header) holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.socket.settimeout(max(0.01, end - time.monotonic()))
            header, payload = parsed(self.receive())
            if header["type"] == "frame":
                self.send({"type": "got", "picture": header["picture"]})
            if condition(header):
                return header, payload
        raise TimeoutError("no such message")

    def frame(self, condition=lambda header: True, seconds=60.0):
        return self.wait_for(lambda h: h["type"] == "frame" and condition(h), seconds)
