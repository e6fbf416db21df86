"""A Firefox that nobody sees, driven by WebDriver BiDi: the same to a test as `browser.Page`.

Without a screen it draws no WebGL; where there is an Xvfb it has a screen that is none.
"""

import base64
import json
import os
import re
import secrets
import shutil
import socket
import struct
import subprocess

_NAMES = ("firefox-esr", "firefox")
_PATIENCE_S = 60
_KEYS = {
    "Enter": "\ue006", "Escape": "\ue00c", "Tab": "\ue004", "ArrowLeft": "\ue012",
    "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015",
}  # fmt: skip
_CTRL = "\ue009"
# no graphics card is needed, nothing is asked of the network, and no page of its own is shown
_PREFERENCES = {
    "app.update.auto": False,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "webgl.force-enabled": True,
}


def find():
    """The browser's program: that of FIREFOX, or the first known name on the path; else None."""
    return os.environ.get("FIREFOX") or next(filter(None, map(shutil.which, _NAMES)), None)


class Page:
    """A browser with one page, closed at the end of a `with` block.

    Attributes
    ----------
    complaints : list of str
        What the console got at the levels warning and error, and requests that left the page.
    has_screen : bool
    """

    def __init__(self, folder):
        lines = [f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in _PREFERENCES.items()]
        (folder / "user.js").write_text("\n".join(lines))
        self.complaints, self._answers, self._next = [], {}, 0
        self._screen, shown = _open_screen()
        self.has_screen = self._screen is not None
        self._process = subprocess.Popen(
            [
                find(), *([] if self.has_screen else ["--headless"]), "--no-remote",
                "--profile", str(folder), "--remote-debugging-port", "0",
            ],
            env={**os.environ, **shown}, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, start_new_session=True,
        )  # fmt: skip
        said = (re.search(r"listening on ws://127\.0\.0\.1:(\d+)", s) for s in self._process.stderr)
        self._socket = _Socket(int(next(filter(None, said))[1]))
        self.ask("session.new", capabilities={})
        events = ["log.entryAdded", "network.beforeRequestSent"]
        self.ask("session.subscribe", events=events)
        # the first window never has the focus, without which keys press no button
        self._context = self.ask("browsingContext.create", type="window")["context"]

    def open(self, url, *, width=1280, height=900):
        """Load a page afresh in a window of a size."""
        self.complaints.clear()
        size = {"width": width, "height": height}
        self.ask("browsingContext.setViewport", context=self._context, viewport=size)
        self._url = url
        self.ask("browsingContext.navigate", context=self._context, url=url, wait="complete")
        return self

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._socket.close()
        self._process.kill()
        self._process.wait()
        self._process.stderr.close()
        if self._screen is not None:
            self._screen.kill()
            self._screen.wait()

    def load(self, script):
        """Run a script for what it leaves behind."""
        self._evaluate(f"{script}\n;null")

    def run(self, script):
        """The value of a JavaScript expression."""
        value = self._evaluate(f"(async () => JSON.stringify(await ({script})))()").get("value")
        return None if value is None else json.loads(value)

    def _evaluate(self, script):
        answer = self.ask(
            "script.evaluate", expression=script, target={"context": self._context},
            awaitPromise=True,
        )  # fmt: skip
        assert answer["type"] == "success", answer["exceptionDetails"]["text"]
        return answer["result"]

    def mouse(self, kind, x, y, **_):
        moved = {"type": "pointerMove", "x": round(x), "y": round(y)}
        pressed = {"mousePressed": "pointerDown", "mouseReleased": "pointerUp"}.get(kind)
        then = [{"type": pressed, "button": 0}] if pressed else []
        self._perform({"type": "pointer", "id": "mouse", "actions": [moved, *then]})

    def drag(self, start, end):
        self.mouse("mousePressed", *start)
        for share in (0.3, 0.7, 1.0):
            self.mouse(
                "mouseMoved", *(a + share * (b - a) for a, b in zip(start, end, strict=True))
            )
        self.mouse("mouseReleased", *end)

    def key(self, key, *, ctrl=False):
        value = _KEYS.get(key, key)
        hold, leave = ([{"type": t, "value": _CTRL}] * ctrl for t in ("keyDown", "keyUp"))
        actions = [*hold, *({"type": t, "value": value} for t in ("keyDown", "keyUp")), *leave]
        self._perform({"type": "key", "id": "keys", "actions": actions})

    def type(self, text):
        for letter in text:
            self.key(letter)

    def screenshot(self):
        """The bytes of a PNG of what is in view."""
        shot = self.ask("browsingContext.captureScreenshot", context=self._context)
        return base64.b64decode(shot["data"])

    def ask(self, method, **given):
        self._next += 1
        self._socket.send(json.dumps({"id": self._next, "method": method, "params": given}))
        while self._next not in self._answers:
            message = json.loads(self._socket.receive())
            if "id" in message:
                self._answers[message["id"]] = message
            elif message["type"] == "event":
                self._note(message["method"], message["params"])
        answer = self._answers.pop(self._next)
        assert answer["type"] == "success", answer
        return answer["result"]

    def _perform(self, source):
        self.ask("input.performActions", context=self._context, actions=[source])

    def _note(self, event, about):
        if event == "log.entryAdded" and about["level"] in ("error", "warn"):
            self.complaints.append(about["text"])
        elif event == "network.beforeRequestSent":
            asked = about["request"]["url"]
            if asked != self._url and not asked.startswith(("data:", "blob:", "about:")):
                self.complaints.append(f"request of {asked}")


def _open_screen():
    """Begin a screen in memory; return its process and the variables that lead to it."""
    if shutil.which("Xvfb") is None:
        return None, {}
    to_read, to_write = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(to_write), "-screen", "0", "1400x1000x24", "-nolisten", "tcp"],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        pass_fds=(to_write,), start_new_session=True,
    )  # fmt: skip
    os.close(to_write)
    with os.fdopen(to_read) as said:
        return screen, {"DISPLAY": f":{said.readline().strip()}"}


class _Socket:
    """A connection by WebSocket, as far as a browser beside needs one."""

    def __init__(self, port):
        self._stream = socket.create_connection(("127.0.0.1", port), timeout=_PATIENCE_S)
        key = base64.b64encode(secrets.token_bytes(16)).decode()
        self._stream.sendall(
            f"GET /session HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
            .encode()
        )  # fmt: skip
        self._read = self._stream.makefile("rb")
        assert b"101" in self._read.readline()
        while self._read.readline().strip():
            pass

    def send(self, text):
        content = text.encode()
        n = len(content)
        # lengths of 7, 16 or 64 bits; what a client sends is masked
        if n < 126:
            length = bytes([128 | n])
        else:
            length = struct.pack(">BH", 254, n) if n < 2**16 else struct.pack(">BQ", 255, n)
        mask = secrets.token_bytes(4)
        whole = (mask * (n // 4 + 1))[:n]
        masked = int.from_bytes(content, "big") ^ int.from_bytes(whole, "big")
        self._stream.sendall(b"\x81" + length + mask + masked.to_bytes(n, "big"))

    def receive(self):
        text, is_last = b"", False
        while not is_last:
            head, n = self._read.read(2)
            n = {126: lambda: self._number(2), 127: lambda: self._number(8)}.get(n, lambda n=n: n)()
            part = self._read.read(n)
            assert head & 15 != 8, "the browser has ended"
            if head & 15 in (0, 1):
                text, is_last = text + part, bool(head & 128)
        return text.decode()

    def _number(self, n_bytes):
        return int.from_bytes(self._read.read(n_bytes), "big")

    def close(self):
        self._read.close()
        self._stream.close()
