"""A headless Chromium, driven over its DevTools pipe: pages as a person sees them."""

import base64
import json
import os
import select
import shutil
import subprocess

_NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
)
_PATIENCE_S = 30


def find():
    """The browser's program: that of CHROMIUM, or the first known name on the path; else None."""
    return os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, _NAMES)), None)


class Page:
    """A browser with one page, closed at the end of a `with` block.

    Attributes
    ----------
    complaints : list of str
        What the console got at the levels warning and error, exceptions, and requests that left
        the page.
    """

    def __init__(self, folder):
        self.complaints, self._answers, self._next, self._rest, self._loaded = [], {}, 0, b"", set()
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()
        self._process = subprocess.Popen(
            [
                find(), "--headless=new", "--remote-debugging-pipe", "--no-sandbox",
                "--disable-gpu", "--no-first-run", "--disable-dev-shm-usage",
                # WebGL without a graphics card
                "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                "--disable-background-networking", f"--user-data-dir={folder}",
                "about:blank",
            ],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            pass_fds=(3, 4), preexec_fn=lambda: _place(to_read, to_write), start_new_session=True,
        )  # fmt: skip
        os.close(to_read), os.close(to_write)
        targets = self._ask("Target.getTargets")["targetInfos"]
        target = next(t["targetId"] for t in targets if t["type"] == "page")
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)[
            "sessionId"
        ]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{domain}.enable")
        self.ask("Page.setLifecycleEventsEnabled", enabled=True)

    def open(self, url, *, width=1280, height=900, dark=False):
        """Load a page afresh in a window of a size, liked light or dark."""
        self.complaints.clear()
        self.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        shade = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.ask("Emulation.setEmulatedMedia", features=shade)
        loader = self.ask("Page.navigate", url=url)["loaderId"]
        while loader not in self._loaded:
            self._listen()
        return self

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._read), os.close(self._write)

    def run(self, script):
        """The value of a JavaScript expression."""
        answer = self.ask(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def mouse(self, kind, x, y, **more):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start, end):
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        for share in (0.3, 0.7, 1.0):
            place = [a + share * (b - a) for a, b in zip(start, end, strict=True)]
            self.mouse("mouseMoved", *place, button="left", buttons=1)
        self.mouse("mouseReleased", *end, button="left", clickCount=1)

    def key(self, key, *, ctrl=False):
        typed = {"Enter": "\r"}.get(key, key if len(key) == 1 and not ctrl else "")
        for kind in ("keyDown", "keyUp"):
            self.ask(
                "Input.dispatchKeyEvent",
                type=kind,
                key=key,
                code=key,
                text=typed,
                modifiers=2 * ctrl,
            )

    def type(self, text):
        self.ask("Input.insertText", text=text)

    def load(self, script):
        """Run a script for what it leaves behind."""
        self.ask("Runtime.evaluate", expression=script)

    def screenshot(self, whole=False):
        """The bytes of a PNG of what is in view, or of the whole page."""
        return base64.b64decode(
            self.ask("Page.captureScreenshot", captureBeyondViewport=whole)["data"]
        )

    def ask(self, method, **given):
        return self._ask(method, sessionId=self._session, **given)

    def _ask(self, method, sessionId=None, **given):  # noqa: N803
        self._next += 1
        message = {"id": self._next, "method": method, "params": given}
        os.write(
            self._write,
            json.dumps(message | ({"sessionId": sessionId} if sessionId else {})).encode() + b"\0",
        )
        while (answer := self._answers.pop(self._next, None)) is None:
            self._listen()
        assert "error" not in answer, answer["error"]
        return answer["result"]

    def _listen(self):
        ready, _, _ = select.select([self._read], [], [], _PATIENCE_S)
        assert ready, "the browser does not answer"
        received = os.read(self._read, 1 << 20)
        assert received, "the browser has ended"
        *whole, self._rest = (self._rest + received).split(b"\0")
        for message in map(json.loads, whole):
            if "id" in message:
                self._answers[message["id"]] = message
            else:
                self._note(message["method"], message["params"])

    def _note(self, event, about):
        if event == "Page.lifecycleEvent" and about["name"] == "load":
            self._loaded.add(about["loaderId"])
        elif event == "Runtime.exceptionThrown":
            self.complaints.append(
                about["exceptionDetails"]["text"] + str(about["exceptionDetails"].get("exception"))
            )
        elif event == "Runtime.consoleAPICalled" and about["type"] in (
            "error",
            "warning",
            "assert",
        ):
            self.complaints.append(str(about["args"]))
        elif event == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            self.complaints.append(about["entry"]["text"])
        elif event == "Network.requestWillBeSent":
            asked = about["request"]["url"]
            if asked != about["documentURL"] and not asked.startswith("data:"):
                self.complaints.append(f"request of {asked}")


def _place(to_read, to_write):
    """Put the pipe's ends where the browser looks for them: 3 to read, 4 to write."""
    spare = [os.dup(to_read), os.dup(to_write)]
    for source, target in zip(spare, (3, 4), strict=True):
        os.dup2(source, target)
