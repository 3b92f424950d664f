"""Button presses without a known command are answered, once each."""

from __future__ import annotations

import pytest

from linkwright.speech.nodes.presses import ButtonPresses
from tests.speech.nodes.fakes import BOOL, ENGINE_ENTRY, final_result, partial_result
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
async def test_unknown_speech_during_press_is_answered_once(engine, start_commander, language, nearest, answer):
    robot = start_commander(engine="told", language=language)
    await robot.hold(True)
    await robot.process(final_result(""), final_result("forward", 0.2))
    engine.results_at_end.append(final_result("", nearest=nearest))
    await robot.hold(False)
    await eventually(lambda: robot.texts_by_topic["response"])
    assert robot.texts_by_topic["response"] == [answer]
    assert robot.texts_by_topic["command"] == []


@pytest.mark.parametrize(
    "heard", [final_result("forward"), final_result("forward", 0.4), partial_result("stop"), final_result("stop", 0.1)]
)
@pytest.mark.parametrize("is_first", [True, False])
async def test_answered_press_does_not_report_unknown_speech(engine, start_commander, heard, is_first):
    robot = start_commander(engine="told")
    await robot.hold(True)
    await robot.process(*((heard, final_result("")) if is_first else (final_result(""), heard)))
    responses = list(robot.texts_by_topic["response"])
    assert len(responses) == 1
    await robot.hold(False)
    await eventually(lambda: engine.finished)
    await robot.finish_results()
    assert robot.texts_by_topic["response"] == responses


async def test_press_with_gap_asks_to_repeat(engine, start_commander):
    robot = start_commander(engine="told")
    await robot.hold(True)
    for index in range(5):
        await robot.process(stamp=10.0 + 0.1 * index)
    await robot.process(stamp=10.6)  # a tenth of a second is missing before this block
    engine.results_at_end.append(final_result("", start=5.0, nearest="forward"))
    await robot.hold(False)
    await eventually(lambda: robot.texts_by_topic["response"])
    assert robot.texts_by_topic["response"] == ["I did not hear all of that, please repeat"]


async def test_presses_are_answered_separately_by_slow_engine(engine, start_commander):
    robot = start_commander(engine="told")
    engine.results_at_end.append(final_result(""))
    for held in (True, False, True, False):
        await robot.hold(held)
    await eventually(lambda: len(engine.finished) == 2)
    await eventually(lambda: len(robot.texts_by_topic["response"]) == 2)
    assert len(set(robot.texts_by_topic["response"])) == 1
    engine.results_at_end.clear()
    await robot.hold(True)
    await robot.hold(False)
    await robot.finish_results()
    assert len(robot.texts_by_topic["response"]) == 2


async def test_open_listening_does_not_report_unknown_speech(engine, start_commander):
    robot = start_commander(engine="told", open_listening=True)
    await robot.process(final_result(""))
    await robot.hold(True)
    await robot.process(final_result(""))
    await robot.hold(False)
    await eventually(lambda: engine.finished)
    await robot.finish_results()
    assert robot.texts_by_topic["response"] == []


def fail_presses(presses, times):
    answers = []
    for _ in range(times):
        presses.begin()
        presses.record_unknown_speech(final_result(""))
        answers.append("enroll" in str(presses.end()))
    return answers


def test_enrolling_is_proposed_after_three_failed_presses():
    assert fail_presses(ButtonPresses(can_enroll=True), 7) == [False, False, True, False, False, True, False]
    assert fail_presses(ButtonPresses(), 6) == [False] * 6


def test_command_resets_count_of_failed_presses():
    presses = ButtonPresses(can_enroll=True)
    fail_presses(presses, 2)
    presses.begin()
    presses.record_command()
    presses.end()
    assert fail_presses(presses, 3) == [False, False, True]


def test_proposal_lasts_until_next_press_or_command():
    presses = ButtonPresses(can_enroll=True)
    fail_presses(presses, 3)
    assert presses.proposes_enrolling
    presses.begin()
    assert not presses.proposes_enrolling
    presses.end()
    fail_presses(presses, 3)
    presses.record_command()
    assert not presses.proposes_enrolling


@pytest.mark.parametrize(
    ("parameters", "proposed"),
    [({}, [True, False]), ({"words_file": "/words.json"}, []), ({"open_listening": True}, [])],
    ids=["usual file", "a file that pages do not write", "listens to all"],
)
async def test_enrolling_proposal_is_published_and_withdrawn(
    engine, start_commander, harness, monkeypatch, parameters, proposed
):
    monkeypatch.setattr("linkwright.speech.engine.extensions", lambda group: {"enrolled": ENGINE_ENTRY})
    messages = []
    harness.node.create_subscription(
        BOOL, "/voice/propose_enrolling", lambda message: messages.append(message.data), 10
    )
    robot = start_commander(engine="enrolled", **parameters)
    engine.results_at_end.append(final_result(""))
    for _ in range(3):
        await robot.hold(True)
        await robot.hold(False)
    await eventually(lambda: len(engine.finished) == 3)
    await robot.finish_results()
    assert messages == proposed
