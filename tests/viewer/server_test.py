"""The viewer's server: who is answered and who is not, and clients that misbehave.

Usage: server_test.py MOTE SCENE
"""
import http.client
import os
import sys
import tempfile
import time
from urllib.parse import urlsplit

from view_program import Program

mote, scene = sys.argv[1:3]


def check(holds, what):
    print(("ok      " if holds else "FAILED  ") + what, flush=True)
    if not holds:
        sys.exit(1)


def get(url, path, **headers):
    parts = urlsplit(url)
    connection = http.client.HTTPConnection(parts.hostname, parts.port, timeout=20)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    return answer.status, answer.read(), dict(answer.getheaders())


def refused(connect):
    try:
        connect()
    except (ConnectionError, OSError) as error:
        return str(error)
    return ""


def with_bystanders(folder):
    """What the folder holds: files that no client named."""
    held = {}
    for name in ("view.exr", "view.png", "A.exr", "scene.exr", "scene.png", "scene.json", "scene.exr.checkpoint"):
        held[name] = f"this is {name}"
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(held[name])
    return held


def contents(folder):
    held = {}
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), encoding="ascii") as file:
            held[name] = file.read()
    return held


def main():
    with tempfile.TemporaryDirectory() as folder:
        held = with_bystanders(folder)
        attack(folder)
        check(contents(folder) == held, "nothing is written into the folder of the program, nor removed")
    print("passed")


def attack(folder):
    with Program(os.path.abspath(mote), os.path.abspath(scene), "-D", "film.width=64", "-D", "film.height=64", "--integrator", "path",
                 "--passes", "4", cwd=folder) as program:
        parts = urlsplit(program.url)
        base = parts.path
        check(parts.hostname == "127.0.0.1" and len(base) == 34, "loopback, and 128 bits of token")
        status, page, headers = get(program.url, base)
        check(status == 200 and b"mote view" in page, "the page")
        check("script-src 'self'" in headers["Content-Security-Policy"], "runs its own scripts alone")
        for path, expected in ((base + "viewer.js", 200), ("/", 404), ("/viewer.js", 404), (base[:-2] + "x/", 404),
                               (base + "../../../etc/passwd", 404), (base + "%2e%2e/scene.xml", 404),
                               (base + "socket", 400), (base + "index.html?x=1", 200)):
            check(get(program.url, path)[0] == expected, f"{path.replace(base, '/TOKEN/')}: {expected}")
        check(get(program.url, base, Host="evil.example")[0] == 403, "another Host is refused")
        check(get(program.url, base, Host=f"localhost:{parts.port}")[0] == 200, "localhost is this host")
        check(get(program.url, base, Origin="http://evil.example")[0] == 403, "another Origin is refused")
        check("403" in refused(lambda: program.connect(origin="http://evil.example")), "also for messages")
        program.connect(origin=f"http://{parts.netloc}").close()

        client = program.connect()
        client.wait_for(lambda h: h["type"] == "scene")
        client.frame(lambda h: h["finished"])
        for bad in ("", "{", "[]", "null", '{"type": 3}', '{"type": "nothing"}', '{"type": "set", "define": []}',
                    '{"type": "set", "define": {"a": "b"}}', '{"type": "set", "define": {"shape:1.filename": "/etc/passwd"}}',
                    '{"type": "set", "define": {"integrator.filename": "x"}}', '{"type": "set", "picture": "Z"}',
                    '{"type": "camera", "view": [1, 2]}', '{"type": "camera", "view": [1, 2, 3, 4, 5, 6, 7, 8, 1e999]}',
                    '{"type": "pixel", "picture": "A", "x": -1, "y": 2}', '{"type": "save", "picture": "C"}'):
            client.send(bad)
            check(client.wait_for(lambda h: h["type"] == "refused")[0]["text"] != "", f"answered: {bad or 'nothing'}")
        client.send({"type": "set", "define": {"integrator.max_depth": "many"}})
        problem = client.wait_for(lambda h: h["type"] == "problem")[0]["text"]
        check("max_depth" in problem or "many" in problem, f"a wrong value: {problem}")
        client.send({"type": "set", "define": {"integrator.max_depth": None}})
        client.frame(lambda h: h["finished"])
        client.send({"type": "save", "picture": "A"})
        check(client.wait_for(lambda h: h["type"] == "file")[1][:4] == b"\x76\x2f\x31\x01", "a saved picture is sent")

        others = [program.connect() for _ in range(9)]
        check("503" in refused(program.connect), "ten clients, and no more")
        for other in others:
            other.close()
        client.send("x" * 70000)
        check(refused(lambda: client.wait_for(lambda h: False, 5)) != "", "a message that is too long ends the connection")
        silent = program.connect()  # confirms nothing: it gets one frame
        silent.wait_for(lambda h: h["type"] == "scene")
        other = program.connect()
        for _ in range(1000):
            silent.send("{")
        other.send({"type": "set", "seed": 2})
        begin = time.monotonic()
        other.frame(lambda h: h["finished"])
        check(time.monotonic() - begin < 5, "a client that floods delays no other")
        check(program.is_alive(), "alive")


main()
