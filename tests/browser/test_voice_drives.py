"""From the microphone to the wheels.

Words are enrolled and spoken in a real browser, and mbot obeys.

The browser's microphone is a file, which gets another word before each opening of the microphone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, Playwright

from linkwright.speech.sound.wav import encode_wav
from tests.browser.conftest import Start, run_browser, state, until
from tests.browser.live import POLL_PERIOD_S
from tests.speech.voices import WORDS, say
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

SILENCE_S = 1.5
PAUSE_S = 1.2
"""The time in seconds that the button is held before and after the word; the file is much longer."""

_RECORD_MICROPHONE = """
const get = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);
navigator.mediaDevices.getUserMedia = async (wanted) => (window.heard = await get(wanted));
"""
_BUSY = """
const add = AudioWorklet.prototype.addModule;
let late = 1500;
AudioWorklet.prototype.addModule = async function (url) {
  await new Promise((resolve) => setTimeout(resolve, late));
  late = 0;
  return add.call(this, url);
};
"""
"""Delays the first load of the browser's audio worklet by more than the length of a word."""
_UNPLUGGED = "window.heard?.getTracks().forEach((track) => { track.stop(); track.dispatchEvent(new Event('ended')); })"


class Microphone:
    """The file that the browser reads each time it opens the microphone."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.put(np.zeros(16_000, np.int16))

    def put(self, samples: np.ndarray) -> None:
        silence = np.zeros(5 * 16_000, np.int16)
        new_path = self._path.with_suffix(".new")
        new_path.write_bytes(encode_wav(np.concatenate((samples, silence))))
        new_path.replace(self._path)


@pytest.fixture(scope="module")
def microphone(tmp_path_factory: pytest.TempPathFactory) -> Microphone:
    return Microphone(tmp_path_factory.mktemp("sound") / "said.wav")


@pytest.fixture(scope="module")
def browser(playwright: Playwright, microphone: Microphone) -> Iterator[Browser]:
    """Run a browser that grants the microphone, and reads its file."""
    fake = ("--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream")
    with run_browser(playwright, *fake, f"--use-file-for-fake-audio-capture={microphone._path}") as new_browser:
        yield new_browser


def speak(page: Page, button: Locator, microphone: Microphone, word: str, *, seed: int, **voice: float) -> None:
    """Hold a button and speak a word."""
    samples = say(WORDS[word], silence=SILENCE_S, seed=seed, **voice)
    page.evaluate(_UNPLUGGED)
    until(page, "lw.panels.voice.isOpen === false")
    microphone.put(samples)
    button.focus()
    page.keyboard.down("Space")
    until(page, "lw.panels.voice.isOpen")
    # The browser plays the sound in real time.
    page.wait_for_timeout(1000 * (len(samples) / 16_000 - SILENCE_S + PAUSE_S))
    page.keyboard.up("Space")


def robot_position(page: Page) -> tuple[float, float]:
    x, y, *_ = state(page, "frames")["base_footprint"]["position"]
    return x, y


def test_enrolled_words_drive_and_stop_mbot(
    start: Start,
    open_page: Callable[..., Page],
    microphone: Microphone,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    program = start("launch", "my_robot_voice", "voice.launch.py")
    page = open_page(program, wait=False)
    words = page.locator(".word-box summary")
    words.wait_for()  # a robot with voice commands opens the panel
    page.add_init_script(_RECORD_MICROPHONE)
    page.add_init_script(_BUSY)
    page.reload()
    until(page, "lw.ready && 'base_footprint' in lw.frames")
    words.click()
    for word in ("forward", "stop"):
        page.get_by_label("Word or phrase of a command").fill(word)
        page.keyboard.press("Enter")
        button = page.get_by_role("button", name=f"Hold and say: {word}", exact=True)
        row = page.locator(".word", has=button)
        for take, speed in enumerate((1.0, 0.93, 1.07), 1):
            speak(page, button, microphone, word, seed=take, speed=speed)
            verdict = row.locator(".word-judged:has-text(' dB, ')")
            verdict.wait_for()
            # The page of a busy machine loses parts of the sound, and reports that.
            while any(problem in verdict.inner_text() for problem in ("gaps", "begins or ends")):
                speak(page, button, microphone, word, seed=take, speed=speed)
                verdict.wait_for()
            row.locator(f".word-takes:text-is('{take}/3')").wait_for()

    talk_button = page.locator(".voice-talk")
    x, y = robot_position(page)
    speak(page, talk_button, microphone, "forward", seed=7, speed=0.97)
    page.wait_for_selector(".voice-said:has-text('understood') >> text=forward")
    wait_until(
        lambda: math.hypot(robot_position(page)[0] - x, robot_position(page)[1] - y) > 0.2,
        what=lambda: robot_position(page),
        pause=POLL_PERIOD_S,
    )
    speak(page, talk_button, microphone, "stop", seed=8, speed=1.03)
    page.wait_for_selector(".voice-said:has-text('understood') >> text=stop")
    positions = [robot_position(page)]

    def is_standing() -> bool:
        page.wait_for_timeout(300)
        positions.append(robot_position(page))
        return math.dist(positions[-1], positions[-2]) < 1e-3

    wait_until(is_standing, what=lambda: positions)
    assert program.process.poll() is None
