"""Who held the button and was not understood is told so, once."""

from __future__ import annotations

import pytest

from linkwright.speech.nodes.presses import ButtonPresses
from tests.speech.nodes.fakes import BOOL, ENTRY, final, partial
from tests.waiting import eventually


@pytest.mark.parametrize(
    ("language", "nearest", "answer"),
    [
        ("en", "", "I heard something that is not a command"),
        ("zh", "", "我听到了声音，但不是任何命令"),
        ("en", "turn left", "I heard something that is not a command; the most similar one is 'turn left'"),
        ("zh", "左转", "我听到了声音，但不是任何命令，最接近的是“左转”"),
    ],
)
async def test_who_held_the_button_is_told_once_that_it_was_no_command(engine, talk, language, nearest, answer):
    robot = talk(engine="told", language=language)
    await robot.hold(True)
    await robot.say(final(""), final("forward", 0.2))
    engine.says_at_end.append(final("", nearest=nearest))
    await robot.hold(False)
    await eventually(lambda: robot.said["response"])
    assert robot.said["response"] == [answer]
    assert robot.said["command"] == []


@pytest.mark.parametrize("heard", [final("forward"), final("forward", 0.4), partial("stop"), final("stop", 0.1)])
@pytest.mark.parametrize("is_first", [True, False])
async def test_who_was_understood_or_answered_is_not_told_of_what_else_was_heard(engine, talk, heard, is_first):
    robot = talk(engine="told")
    await robot.hold(True)
    await robot.say(*((heard, final("")) if is_first else (final(""), heard)))
    answers = list(robot.said["response"])
    assert len(answers) == 1
    await robot.hold(False)
    await eventually(lambda: engine.finished)
    await robot.say_nothing_more()
    assert robot.said["response"] == answers


async def test_of_a_press_with_a_gap_anywhere_it_is_asked_for_again(engine, talk):
    robot = talk(engine="told")
    await robot.hold(True)
    for each in range(5):
        await robot.say(stamp=10.0 + 0.1 * each)
    await robot.say(stamp=10.6)  # a tenth of a second is missing, long before what is heard
    engine.says_at_end.append(final("", start=5.0, nearest="forward"))
    await robot.hold(False)
    await eventually(lambda: robot.said["response"])
    assert robot.said["response"] == ["I did not hear all of that, please repeat"]


async def test_each_press_is_answered_by_itself_however_late_the_engine_is(engine, talk):
    robot = talk(engine="told")
    engine.says_at_end.append(final(""))
    for held in (True, False, True, False):
        await robot.hold(held)
    await eventually(lambda: len(engine.finished) == 2)
    await eventually(lambda: len(robot.said["response"]) == 2)
    assert len(set(robot.said["response"])) == 1
    engine.says_at_end.clear()
    await robot.hold(True)
    await robot.hold(False)
    await robot.say_nothing_more()
    assert len(robot.said["response"]) == 2


async def test_who_listens_to_all_does_not_tell_what_is_no_command(engine, talk):
    robot = talk(engine="told", open_listening=True)
    await robot.say(final(""))
    await robot.hold(True)
    await robot.say(final(""))
    await robot.hold(False)
    await eventually(lambda: engine.finished)
    await robot.say_nothing_more()
    assert robot.said["response"] == []


def missed(presses, times):
    answers = []
    for _ in range(times):
        presses.begin()
        presses.record_unknown_speech(final(""))
        answers.append("enroll" in str(presses.end()))
    return answers


def test_after_three_presses_without_a_command_enrolling_is_proposed():
    assert missed(ButtonPresses(can_enroll=True), 7) == [False, False, True, False, False, True, False]
    assert missed(ButtonPresses(), 6) == [False] * 6


def test_a_command_between_them_begins_the_count_anew():
    presses = ButtonPresses(can_enroll=True)
    missed(presses, 2)
    presses.begin()
    presses.record_command()
    presses.end()
    assert missed(presses, 3) == [False, False, True]


def test_the_proposal_stands_until_the_next_press_or_command():
    presses = ButtonPresses(can_enroll=True)
    missed(presses, 3)
    assert presses.proposes_enrolling
    presses.begin()
    assert not presses.proposes_enrolling
    presses.end()
    missed(presses, 3)
    presses.record_command()
    assert not presses.proposes_enrolling


@pytest.mark.parametrize(
    ("parameters", "proposed"),
    [({}, [True, False]), ({"words_file": "/words.json"}, []), ({"open_listening": True}, [])],
    ids=["usual file", "a file that pages do not write", "listens to all"],
)
async def test_pages_are_told_when_enrolling_is_proposed_and_when_no_longer(
    engine, talk, stage, monkeypatch, parameters, proposed
):
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"enrolled": ENTRY})
    messages = []
    stage.node.create_subscription(BOOL, "/voice/propose_enrolling", lambda message: messages.append(message.data), 10)
    robot = talk(engine="enrolled", **parameters)
    engine.says_at_end.append(final(""))
    for _ in range(3):
        await robot.hold(True)
        await robot.hold(False)
    await eventually(lambda: len(engine.finished) == 3)
    await robot.say_nothing_more()
    assert messages == proposed
