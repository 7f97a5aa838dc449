"""Malformed requests and messages against `mote view`: none crashes it, hangs it or makes it grow.

Usage: fuzz_server.py MOTE SCENE [--count 10000] [--seed 1]
"""
import argparse
import json
import os
import random
import select
import socket
import struct
import sys
import time
from urllib.parse import urlsplit

from view_program import Program

parser = argparse.ArgumentParser()
parser.add_argument("mote")
parser.add_argument("scene")
parser.add_argument("--count", type=int, default=10000)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
rng = random.Random(arguments.seed)

WORDS = ["type", "set", "camera", "second", "pixel", "save", "reproduce", "got", "hello", "stop", "start", "picture", "A",
         "B", "define", "integrator", "path", "mote_vpl", "integrator.paths", "sensor.to_world", "film.width", "view",
         "moving", "x", "y", "seed", "passes", "emitter:1.radiance", "emitter:9.scale", "a.b.c.d", "", "\0", "é", "$x", ":",
         "integrator.type", ".", "..", "shape:1.filename", "../../secret", "9" * 50, "e" * 1000]
NUMBERS = [0, -1, 1, 3, 1e308, -1e308, 1e-320, 2 ** 31, 2 ** 63, 2 ** 64, 0.5, 4294967296]
# Changes that are in order but take long are none for this test.
HARMLESS = {"film.width", "film.height", "passes", "film.sample_count"}


def value(depth=0):
    kind = rng.randrange(8 if depth < 4 else 5)
    if kind == 0:
        return rng.choice([None, True, False])
    if kind in (1, 2):
        return rng.choice(NUMBERS)
    if kind in (3, 4):
        return rng.choice(WORDS)
    if kind == 5:
        return [value(depth + 1) for _ in range(rng.randrange(12))]
    return {rng.choice(WORDS): value(depth + 1) for _ in range(rng.randrange(6))}


def message():
    kind = rng.randrange(6)
    if kind == 0:
        return os.urandom(rng.randrange(200))
    if kind == 1:
        return b"[" * rng.randrange(20000)
    content = value()
    if kind > 2:
        content = {"type": rng.choice(WORDS[1:11]), **{rng.choice(WORDS[11:25]): value(2) for _ in range(rng.randrange(5))}}
        content.pop("passes", None)
    text = bytearray(json.dumps(content).encode())
    if kind == 2 and text:
        for _ in range(rng.randrange(1, 4)):
            text[rng.randrange(len(text))] = rng.randrange(256)
    if any(word.encode() in text for word in HARMLESS):
        text = text.replace(b"film.", b"fild.").replace(b"passes", b"passed")
    return bytes(text)


def frame(payload):
    """A frame, most of them as the protocol wants it."""
    broken = rng.randrange(40)
    opcode = rng.choice([1] * 40 + [2, 0, 8, 9, 10, 3, 15])
    first = (0x80 if broken != 1 else rng.randrange(256)) | opcode
    mask = os.urandom(4) if broken != 2 else b""
    size = len(payload) if broken != 3 else rng.choice([0, 5, 2 ** 40, 2 ** 63])
    head = bytes([first & 255])
    flag = 0x80 if mask else 0
    if size < 126:
        head += bytes([flag | size])
    elif size < 65536:
        head += bytes([flag | 126]) + struct.pack(">H", size)
    else:
        head += bytes([flag | 127]) + struct.pack(">Q", size)
    if mask:
        payload = bytes(b ^ mask[i % 4] for i, b in enumerate(payload))
    data = head + mask + payload
    return data if broken != 4 else data[:rng.randrange(len(data) + 1)]


def request(parts):
    base = parts.path
    path = rng.choice([base, base + "socket", base + "viewer.js", base + "../x", "/", base * 50, "*", "http://x/", "\x01", "/%00"])
    method = rng.choice(["GET", "GET", "GET", "POST", "HEAD", "BREW", "", "G\0T", "CONNECT"])
    version = rng.choice(["HTTP/1.1", "HTTP/1.1", "HTTP/1.0", "HTTP/9.9", "", "X"])
    lines = [f"{method} {path} {version}"]
    options = [f"Host: {parts.netloc}", "Host: evil", "Host:", "Origin: null", f"Origin: http://{parts.netloc}",
               "Content-Length: 10", "Content-Length: -1", "Content-Length: 99999999999", "Transfer-Encoding: chunked",
               "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Key: AAAA", "Sec-WebSocket-Version: 99",
               "X: " + "a" * rng.choice([1, 100, 9000]), "\x00: \x01", "no colon", "Expect: 100-continue"]
    lines += rng.sample(options, rng.randrange(8))
    data = "\r\n".join(lines).encode("latin1") + rng.choice([b"\r\n\r\n", b"\r\n\r\n", b"", b"\n\n", b"\r\n\r\n5\r\nabcde\r\nzz"])
    if rng.randrange(4) == 0 and data:
        data = bytearray(data)
        for _ in range(rng.randrange(1, 6)):
            data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


refusals = 0


def drain(connection, seconds=0.0):
    """Discards what has arrived, and counts refusals. False: the connection has ended."""
    global refusals
    while select.select([connection], [], [], seconds)[0]:
        try:
            data = connection.recv(1 << 20)
            refusals += data.count(b'"refused"')
            if not data:
                return False
        except OSError:
            return False
    return True


def throw_requests(parts, count):
    for _ in range(count):
        with socket.create_connection((parts.hostname, parts.port), timeout=20) as connection:
            try:
                connection.sendall(request(parts))
                if rng.randrange(3):
                    connection.shutdown(socket.SHUT_WR)
                    connection.recv(1 << 16)
            except OSError:
                pass


def throw_messages(program, count):
    client = None
    for i in range(count):
        if client is None or rng.randrange(200) == 0:
            if client:
                client.close()
            client = program.connect()
        try:
            client.socket.sendall(frame(message()))
            if not drain(client.socket, 0.05):  # until the answer, where there is one
                raise OSError
        except OSError:
            client.close()
            client = None
        if i % 150 == 149:
            time.sleep(1.0)  # no more than the server takes in a second
    if client:
        drain(client.socket, 0.5)
        client.close()


def answers(program):
    """A new client is served, within seconds, by a render that is as it was."""
    begin = time.monotonic()
    client = program.connect()
    client.wait_for(lambda h: h["type"] == "scene", 20)
    client.send({"type": "hello"})
    client.wait_for(lambda h: h["type"] == "scene", 20)
    client.close()
    return time.monotonic() - begin


def main():
    with Program(arguments.mote, arguments.scene, "-D", "film.width=32", "-D", "film.height=32", "--integrator", "path",
                 "--passes", "2") as program:
        parts = urlsplit(program.url)
        rounds, sizes, slowest = 10, [], 0.0
        each = max(1, arguments.count // (2 * rounds))
        for _ in range(rounds):
            throw_requests(parts, each)
            throw_messages(program, each)
            slowest = max(slowest, answers(program))
            if not program.is_alive():
                print("FAILED  the program has ended", program.process.returncode)
                sys.exit(1)
            sizes.append(program.resident_bytes() // 2 ** 20)
        print(f"{2 * rounds * each} malformed requests and messages: alive, {refusals} refused with a sentence, "
              f"slowest answer to a new client {slowest:.2f} s, "
              f"resident {sizes} MB")
        if refusals < arguments.count // 20:
            print("FAILED  too few messages arrived")
            sys.exit(1)
        growth = sizes[-1] - sizes[rounds // 2]
        if growth > 64:
            print(f"FAILED  the program grew by {growth} MB in the second half")
            sys.exit(1)
        with open(f"/proc/{program.process.pid}/status", encoding="ascii") as status:
            threads = next(line.split()[1] for line in status if line.startswith("Threads"))
        files = len(os.listdir(f"/proc/{program.process.pid}/fd"))
        print(f"{threads} threads, {files} open files")
        if files > 100:
            print("FAILED  files are left open")
            sys.exit(1)
    print("passed")


main()
