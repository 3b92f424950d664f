"""The Voice panel in a real browser whose microphone is a file with a tone."""

from __future__ import annotations

import wave
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, Playwright, expect

from linkwright.messages import get_message
from linkwright.speech.enrolled.words import RECOMMENDED_TAKES, Take, Words, find_words_path
from linkwright.speech.sound.spectra import BANDS
from tests.browser.conftest import run_browser, until
from tests.browser.live import LiveViewer, configuration
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.browser

TONE_HZ = 440.0
GRID = "- Class: rviz_default_plugins/Grid\n  Enabled: true\n  Name: Grid"
STRING = "std_msgs/msg/String"


@pytest.fixture(scope="module")
def browser(playwright: Playwright, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """Run a browser that grants the microphone, which records a tone."""
    path = tmp_path_factory.mktemp("sound") / "tone.wav"
    _write_tone(path)
    fake = ("--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream")
    with run_browser(playwright, *fake, f"--use-file-for-fake-audio-capture={path}") as new_browser:
        yield new_browser


def _write_tone(path: Path) -> None:
    samples = np.sin(2 * np.pi * TONE_HZ * np.arange(48_000) / 48_000) * 12_000
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(48_000)
        file.writeframes(samples.astype("<i2").tobytes())


class Robot:
    """A node that records the page's speech messages, and responds."""

    def __init__(self, viewer: LiveViewer) -> None:
        self.viewer = viewer
        self.samples: list[np.ndarray] = []
        self.button_states: list[bool] = []
        self.commands: list[str] = []
        viewer.run(self._listen)

    def _listen(self) -> None:
        node = self.viewer.node
        node.create_subscription("audio_common_msgs/msg/AudioDataStamped", "/audio/audio_stamped", self._on_audio, 100)
        node.create_subscription(
            "std_msgs/msg/Bool", "/voice/listen", lambda message: self.button_states.append(message.data), 10
        )
        node.create_subscription(STRING, "/voice/text_input", lambda message: self.commands.append(message.data), 10)

    def _on_audio(self, message: Any) -> None:
        self.samples.append(np.frombuffer(bytes(message.audio.data), "<i2"))

    @property
    def seconds(self) -> float:
        return sum(sample.size for sample in self.samples) / 16_000

    def publish_text(self, topic: str, text: str) -> None:
        self.viewer.publish(f"/voice/{topic}", get_message(STRING)(data=text))


@pytest.fixture
def voice_page(start_viewer: Callable[..., LiveViewer], open_page: Callable[..., Page]) -> tuple[Robot, Page]:
    viewer = start_viewer(configuration(GRID))
    robot = Robot(viewer)
    page = open_page(viewer, wait=False)
    until(page, "lw.displays.length === 1")
    return robot, page


def open_panel(page: Page) -> None:
    page.get_by_role("button", name="Panels").click()
    page.get_by_role("menuitemcheckbox", name="Voice").click()
    page.wait_for_selector(".voice-talk")


def test_push_to_talk_key_records_while_held(voice_page: tuple[Robot, Page]) -> None:
    robot, page = voice_page
    page.keyboard.down("v")
    wait_until(lambda: robot.seconds > 1.0, TIMEOUT_S)
    assert robot.button_states == [True]
    page.keyboard.up("v")
    wait_until(lambda: robot.button_states == [True, False], TIMEOUT_S)
    until(page, "lw.panels.voice.mode === 'ready'")
    # All blocks but the last are a tenth of a second; without gaps, a tone has one line in its spectrum.
    assert {sample.size for sample in robot.samples[:-1]} == {1600}
    sound = np.concatenate(robot.samples)[1600:11200].astype(float)
    spectrum = np.abs(np.fft.rfft(sound * np.hanning(sound.size))) ** 2
    strongest = int(np.argmax(spectrum))
    assert abs(strongest * 16_000 / sound.size - TONE_HZ) < 4
    assert spectrum[strongest - 8 : strongest + 9].sum() > 0.9 * spectrum.sum()


def test_conversation_is_shown_and_commands_can_be_typed(voice_page: tuple[Robot, Page]) -> None:
    robot, page = voice_page
    open_panel(page)
    until(page, "lw.panels.voice.serverState?.text_listeners === 1")
    robot.publish_text("partial_text", "turn")
    page.wait_for_selector(".voice-said.partial:has-text('turn')")
    for topic, text in (("text", "turn left"), ("command", "turn (angle 90°)"), ("response", "Turning left.")):
        robot.publish_text(topic, text)
    page.wait_for_selector(".voice-said.response:has-text('Turning left.')")
    assert page.locator(".voice-said").count() == 3
    field = page.get_by_label("Command as text")
    field.fill("go to the kitchen")
    field.press("v")  # a letter in a text field
    field.press("Enter")
    wait_until(lambda: robot.commands == ["go to the kitchenv"], TIMEOUT_S)
    assert robot.button_states == []


def test_talk_button_releases_when_page_loses_focus(voice_page: tuple[Robot, Page]) -> None:
    robot, page = voice_page
    open_panel(page)
    page.locator(".voice-talk").focus()
    page.keyboard.down("Space")
    wait_until(lambda: robot.button_states == [True], TIMEOUT_S)
    page.evaluate("window.dispatchEvent(new Event('blur'))")
    wait_until(lambda: robot.button_states == [True, False], TIMEOUT_S)
    page.keyboard.up("Space")
    page.get_by_label("Open listening").check()
    # The limit is low, because browsers suppress steady tones.
    until(page, "lw.panels.voice.mode === 'open' && lw.panels.voice.peak > 0.02")
    seconds = robot.seconds
    wait_until(lambda: robot.seconds > seconds + 0.3, TIMEOUT_S)
    assert robot.button_states == [True, False]


_REFUSE = "navigator.mediaDevices.getUserMedia = () => Promise.reject(new DOMException('', '{}')); 0"


@pytest.mark.parametrize(
    ("breaks", "text"),
    [
        ("Object.defineProperty(window, 'isSecureContext', {value: false}); 0", "ssh -L"),
        (_REFUSE.format("NotAllowedError"), "not allowed"),
        (_REFUSE.format("NotFoundError"), "No microphone"),
    ],
    ids=["insecure", "denied", "none"],
)
def test_reason_for_missing_audio_is_shown(voice_page: tuple[Robot, Page], breaks: str, text: str) -> None:
    robot, page = voice_page
    page.evaluate(breaks)
    page.locator(".scene-tool.talk").hover()
    page.mouse.down()
    page.wait_for_selector(f".voice-notice:has-text('{text}')")
    page.mouse.up()
    assert robot.samples == []


def test_lost_microphone_is_reported(voice_page: tuple[Robot, Page]) -> None:
    robot, page = voice_page
    page.evaluate(
        "const get = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);"
        "navigator.mediaDevices.getUserMedia = async (wanted) => (window.heard = await get(wanted)); 0"
    )
    page.keyboard.down("v")
    wait_until(lambda: robot.seconds > 0.1, TIMEOUT_S)
    page.evaluate("window.heard.getTracks()[0].dispatchEvent(new Event('ended'))")
    page.wait_for_selector(".voice-notice:has-text('disconnected')")
    wait_until(lambda: robot.button_states == [True, False], TIMEOUT_S)
    page.keyboard.up("v")


def test_word_is_recorded_while_button_is_held(voice_page: tuple[Robot, Page], monkeypatch, tmp_path: Path) -> None:
    robot, page = voice_page
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    open_panel(page)
    page.locator(".word-box summary").click()
    page.get_by_label("Word or phrase of a command").fill("stop")
    page.keyboard.press("Enter")
    button = page.get_by_role("button", name="Hold and say: stop")
    button.focus()
    page.keyboard.down("Space")
    until(page, "lw.panels.voice.recording && lw.panels.voice.peak > 0.2")
    page.keyboard.up("Space")
    # A continuous tone is not a word: the page must reject it, and not publish it.
    page.wait_for_selector(".word-judged:has-text(' dB, ')")
    assert robot.samples == []


def test_unrecognized_speaker_can_enroll_words_at_this_place(
    voice_page: tuple[Robot, Page], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    robot, page = voice_page
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    rng = np.random.default_rng(1)
    words = Words()
    for name in ("stop", "forward"):
        for _ in range(RECOMMENDED_TAKES):
            words.add(name, Take(rng.uniform(1e3, 1e6, (40, BANDS)), np.ones(BANDS)))
    words.write(find_words_path())
    page.keyboard.down("v")
    wait_until(lambda: robot.button_states == [True], TIMEOUT_S)
    page.keyboard.up("v")
    until(page, "lw.panels.voice.serverState !== null")
    robot.viewer.publish("/voice/propose_enrolling", get_message("std_msgs/msg/Bool")(data=True))
    robot.publish_text("response", "I know none of what you say")
    page.locator(".voice-notice").get_by_role("button", name="Enroll here").click()
    page.get_by_text("0 of 2 words are enrolled here.").wait_for()
    # Speech outside the panel is not counted, and the first word can be recorded at once.
    expect(page.get_by_role("button", name="Hold and say: stop")).to_be_focused()
    assert page.locator(".word-takes").all_text_contents() == ["0/3", "0/3"]
    for element in (page.locator(".voice-notice button"), page.locator(".voice-proposal")):
        expect(element).to_be_hidden()
    page.get_by_role("button", name="Done").click()
    expect(page.locator(".word-here")).to_be_hidden()
    assert page.locator(".word-takes").all_text_contents() == ["3/3", "3/3"]
