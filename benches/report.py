#!/usr/bin/env python3
"""report.html in a real browser: time to the first layer, to the whole part in 3-D, and of slider steps; size; errors on
the console; names and contrast of what is on the page; pictures.

    benches/report.py FOLDER/report.html [--pictures DIR]

Needs chromium (CHROMIUM names another), which draws on the processor here; nothing is installed and nothing loaded.
Ends with status 1 where a limit is broken. Only the standard library: the browser is asked over its pipe.
"""

import argparse
import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

LIMITS = {"first layer, ms": 1000, "slider step, median ms": 50, "size, MB": 12}
SIZES = {"desk": (1280, 900), "phone": (390, 844)}
FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --disable-quic "
    "--no-first-run --disable-background-networking --disable-component-update --disable-sync --remote-debugging-pipe"
)


class Browser:
    """A browser with one page, asked over file descriptors 3 and 4."""

    def __init__(self, program):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        there, self.ask = os.pipe()
        self.answer, back = os.pipe()

        def pipes():
            high = os.dup(there), os.dup(back)
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        command = [program, *FLAGS.split(), f"--user-data-dir={self.folder.name}", "about:blank"]
        self.process = subprocess.Popen(command, preexec_fn=pipes, close_fds=False, stderr=subprocess.DEVNULL)
        os.close(there)
        os.close(back)
        self.rest, self.number, self.session, self.said, self.loaded = b"", 0, None, [], False
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Accessibility"):
            self.call(f"{domain}.enable")

    def close(self):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()

    def message(self):
        while b"\0" not in self.rest:
            read = os.read(self.answer, 1 << 20)
            if not read:
                sys.exit("the browser ended")
            self.rest += read
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **params):
        self.number += 1
        asked = {"id": self.number, "method": method, "params": params}
        if self.session:
            asked["sessionId"] = self.session
        os.write(self.ask, json.dumps(asked).encode() + b"\0")
        while True:
            message = self.message()
            if message.get("id") == self.number:
                if "error" in message:
                    sys.exit(f"{method}: {message['error']['message']}")
                return message["result"]
            self.note(message)

    def note(self, message):
        method, params = message.get("method"), message.get("params", {})
        if method == "Page.loadEventFired":
            self.loaded = True
        elif method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.said.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.said.append(params["entry"]["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] == "error":
            self.said.append(str(params["args"]))

    def value(self, script):
        """What a script gives, or its promise."""
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            sys.exit(f"{script[:80]}: {result['exceptionDetails']['exception'].get('description')}")
        return result["result"].get("value")

    def size(self, width, height):
        phone = width < 600
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def open(self, page):
        self.loaded = False
        self.call("Page.navigate", url=page.resolve().as_uri())
        while not self.loaded:
            self.note(self.message())

    def picture(self, path):
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"]))
        print(path)


WAIT = "new Promise(done => {{ const look = () => {0} ? done(performance.now()) : setTimeout(look, 4); look(); }})"
# From a moved slider to the finished picture: reading a pixel waits for the graphics.
STEP = """(async () => {
  const times = [], gl = space.scene?.gl, pixel = new Uint8Array(4);
  for (let k = 0; k < 24; k++) {
    const at = Math.round((heads.length - 1) * (0.2 + 0.7 * k / 24)), begun = performance.now();
    slider.value = at;
    slider.oninput();
    while (shown.index !== at || waiting) await new Promise(done => setTimeout(done));
    gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    times.push(performance.now() - begun);
  }
  return times;
})()"""
TURN = """(async () => {
  const times = [], gl = space.scene.gl, pixel = new Uint8Array(4);
  for (let k = 0; k < 16; k++) {
    const begun = performance.now();
    turnCamera(space.camera, 0.1, 0);
    stirSolid();
    while (waiting) await new Promise(done => setTimeout(done));
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    times.push(performance.now() - begun);
  }
  return times;
})()"""
# Text whose contrast with what lies behind it is under 4.5 (3 for large text), as WCAG counts it.
PALE = """(() => {
  const numbers = text => (text.match(/[\\d.]+/g) ?? []).map(Number);
  const light = ([r, g, b]) => [r, g, b].map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = node => {
    for (; node; node = node.parentElement) { const c = numbers(getComputedStyle(node).backgroundColor); if (c.length === 3 || c[3] === 1) return c; }
    return [255, 255, 255];
  };
  const found = [];
  for (const node of document.querySelectorAll("body *")) {
    if (!node.checkVisibility() || node.closest("svg") || ![...node.childNodes].some(child => child.nodeType === 3 && child.data.trim())) continue;
    const style = getComputedStyle(node), [a, b] = [light(numbers(style.color)), light(behind(node))].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05), large = parseFloat(style.fontSize) >= 24;
    if (ratio < (large ? 3 : 4.5)) found.push(`${node.textContent.trim().slice(0, 30)}: ${ratio.toFixed(2)}`);
  }
  return found;
})()"""
NAMED = {"button", "link", "slider", "radio", "checkbox", "combobox", "image", "application", "radiogroup"}


def median(values):
    return sorted(values)[len(values) // 2]


def unnamed(browser):
    """Controls and pictures without a name."""
    nodes = browser.call("Accessibility.getFullAXTree")["nodes"]
    role = lambda node: node.get("role", {}).get("value")
    missing = [n for n in nodes if not n.get("ignored") and role(n) in NAMED and not n.get("name", {}).get("value")]
    return [role(node) for node in missing]


def measure(browser, page):
    browser.size(*SIZES["desk"])
    browser.open(page)
    figures = {"size, MB": page.stat().st_size / 1e6}
    figures["first layer, ms"] = browser.value(WAIT.format("typeof shown !== 'undefined' && shown.layer"))
    if browser.value("Boolean(space.scene)"):
        figures["whole part in 3-D, ms"] = browser.value(WAIT.format("solid.dataset.ready"))
        figures["pieces"] = browser.value("space.pieces")
        browser.value("new Promise(done => setTimeout(done, 1500))")
        figures["triangle, µs"] = 1e3 * browser.value("space.rate")
        figures["turn, median ms"] = median(browser.value(TURN))
    steps = browser.value(STEP)
    figures |= {"layers": len(browser.value("heads.map(() => 1)")), "slider step, median ms": median(steps), "slider step, longest ms": max(steps)}
    return figures


def check(browser):
    """What is wrong, as sentences."""
    faults = [f"console: {text}" for text in browser.said]
    faults += [f"{role} without a name" for role in unnamed(browser)]
    for theme in ("light", "dark"):
        browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
        faults += [f"{theme}: too pale: {text}" for text in browser.value(PALE)]
    browser.call("Emulation.setEmulatedMedia", features=[])
    browser.size(*SIZES["phone"])
    wide = browser.value("document.documentElement.scrollWidth")
    if wide > SIZES["phone"][0]:
        faults.append(f"on a phone the page is {wide} px wide")
    return faults


def pictures(browser, page, folder):
    folder.mkdir(parents=True, exist_ok=True)
    rest = "new Promise(done => setTimeout(done, 1200))"
    for name, size in SIZES.items():
        browser.size(*size)
        browser.open(page)
        browser.value(WAIT.format("typeof solid !== 'undefined' && (solid.dataset.ready || !space.scene)"))
        browser.value(rest)
        browser.picture(folder / f"{name}.png")
    browser.size(*SIZES["desk"])
    for colour in ("width", "time"):
        browser.value(f"document.querySelector('[name=colour][value={colour}]').click()")
        browser.value(rest)
        browser.picture(folder / f"{colour}.png")
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    browser.value(rest)
    browser.picture(folder / "dark.png")
    browser.call("Emulation.setEmulatedMedia", media="print", features=[])
    browser.value(rest)
    browser.picture(folder / "print.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("--pictures", type=Path, metavar="DIR")
    asked = parser.parse_args()
    program = os.environ.get("CHROMIUM") or shutil.which("chromium")
    if not program:
        sys.exit("no chromium here: apt-get install --no-install-recommends chromium")
    browser = Browser(program)
    try:
        figures = measure(browser, asked.page)
        for name, value in figures.items():
            print(f"{name:<26} {value:.1f}" if isinstance(value, float) else f"{name:<26} {value}")
        faults = [f"{name} {figures[name]:.1f} is over {most}" for name, most in LIMITS.items() if figures[name] > most]
        faults += check(browser)
        if asked.pictures:
            pictures(browser, asked.page, asked.pictures)
    finally:
        browser.close()
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
