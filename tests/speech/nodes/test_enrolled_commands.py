"""From sound to velocities with the engine of enrolled words: audio messages in, Twist out."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.speech.enrolled.enrollment import enroll
from linkwright.speech.enrolled.words import Words
from linkwright.speech.nodes.audio_messages import make_audio_stamped
from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE
from tests.speech.nodes.fakes import CommanderHarness
from tests.speech.voices import WORDS, say
from tests.waiting import eventually

PAUSE_S = 0.8
"""The seconds of silence before and after a word."""


@pytest.fixture(scope="module")
def words_file(tmp_path_factory):
    words = Words()
    for name, phones in WORDS.items():
        for number in range(3):
            samples = say(phones, speed=0.95 + 0.05 * number, pitch=115 + 5 * number, seed=number)
            assert enroll(words, name, samples) == ()
    path = tmp_path_factory.mktemp("voice") / "words.json"
    words.write(path)
    return path


@pytest.fixture
async def robot(harness, words_file):
    commander_harness = CommanderHarness(harness, engine="enrolled", words_file=str(words_file), open_listening=True)
    yield commander_harness
    commander_harness.commander.close()
    await harness.graph.settle()


async def publish_sound(robot, samples):
    """Publish sound in blocks of 100 ms, as a microphone does."""
    for start in range(0, len(samples), BLOCK_LENGTH):
        robot.sound.publish(
            make_audio_stamped(
                samples[start : start + BLOCK_LENGTH].tobytes(), robot.harness.node.get_clock().now().to_msg()
            )
        )
        await robot.harness.graph.settle()


async def wait_for_commands(robot, *commands):
    """Wait until exactly these commands were executed; the engine works in its own thread."""
    await eventually(lambda: len(robot.texts_by_topic["command"]) >= len(commands), what=lambda: robot.texts_by_topic)
    assert robot.texts_by_topic["command"] == list(commands)
    await robot.harness.graph.settle()


def spoken_word(name):
    return say(WORDS[name], speed=1.04, pitch=122, level=2000, silence=PAUSE_S, seed=21)


@pytest.mark.parametrize(
    ("name", "speed"),
    [
        ("forward", (0.2, 0.0, 0.0)),
        ("back", (-0.2, 0.0, 0.0)),
        ("turn left", (0.0, 0.0, 0.6)),
        ("turn right", (0.0, 0.0, -0.6)),
    ],
)
async def test_enrolled_word_drives_robot(robot, name, speed):
    await publish_sound(robot, spoken_word(name))
    await eventually(lambda: robot.velocities)
    assert robot.speed == speed
    assert robot.texts_by_topic["text"] == [name]


async def test_stop_is_executed_within_300_ms_of_word(robot):
    await publish_sound(robot, spoken_word("forward"))
    await wait_for_commands(robot, "forward")
    sound = spoken_word("stop")
    end = len(sound) - int(PAUSE_S * RATE)
    await publish_sound(robot, sound[: end + int(0.3 * RATE)])  # the word is recognized before its silence ends
    await wait_for_commands(robot, "forward", "stop")
    assert robot.speed == (0.0, 0.0, 0.0)


async def test_noise_and_unknown_words_do_not_drive_robot(robot):
    noise = 300 * np.random.default_rng(22).normal(size=2 * RATE)
    await publish_sound(robot, np.concatenate((noise.astype(np.int16), np.zeros(RATE, np.int16))))
    for phones in ("mumi", "se.pifu", "moramifu"):
        before = len(robot.texts_by_topic["text"])
        await publish_sound(robot, say(phones, silence=PAUSE_S, seed=23))
        await eventually(
            lambda count=before: len(robot.texts_by_topic["text"]) > count, what=lambda: robot.texts_by_topic
        )
    # Commands are executed in the order of the sound, so the earlier words were not commands.
    await publish_sound(robot, spoken_word("back"))
    await wait_for_commands(robot, "backward")
    assert set(robot.texts_by_topic["text"]) == {"", "back"}
