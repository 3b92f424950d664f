"""The command file.

The tests cover the meaning of utterances with the built-in one, and the positions of mistakes in others.
"""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.speech.commands.actions import Drive, Publish, Slot, fill_template
from linkwright.speech.commands.command_file import DEFAULT_FILE, parse_commands, read_command_file
from linkwright.speech.commands.command_set import CommandSet

UNDERSTOOD_TEXTS = [
    ("forward", "forward", {}),
    ("Go forward!", "forward", {}),
    ("前进", "forward", {}),
    ("前 进", "forward", {}),
    ("向前", "forward", {}),
    ("drive forward half a meter", "forward_by", {"distance": 0.5}),
    ("forward two feet", "forward_by", {"distance": 0.6096}),
    ("前进半米", "forward_by", {"distance": 0.5}),
    ("前进 一 点 五 米", "forward_by", {"distance": 1.5}),
    ("后退", "backward", {}),
    ("go back one meter", "backward_by", {"distance": 1.0}),
    ("left", "left", {}),
    ("左转", "left", {}),
    ("turn left ninety degrees", "left_by", {"angle": pi / 2}),
    ("左转九十度", "left_by", {"angle": pi / 2}),
    ("向左转 45 度", "left_by", {"angle": pi / 4}),
    ("右转", "right", {}),
    ("turn right a quarter turn", "right_by", {"angle": pi / 2}),
    ("转两圈", "spin", {"angle": 4 * pi}),
    ("stop", "stop", {}),
    ("停止", "stop", {}),
    ("停下", "stop", {}),
    ("加速", "faster", {}),
    ("slow down", "slower", {}),
    ("减速", "slower", {}),
    ("drive at half a meter per second", "speed", {"speed": 0.5}),
    ("速度每秒半米", "speed", {"speed": 0.5}),
    ("go home", "go_to_place", {"place": "home"}),
    ("回家", "go_to_place", {"place": "home"}),
    ("go to the red ball", "go_to_object", {"object": "red ball"}),
    ("去红球那里", "go_to_object_in_chinese", {"object": "red ball"}),
    ("go to the green ball", "go_to_object", {"object": "green ball"}),
    ("去蓝色的球那里", "go_to_object_in_chinese", {"object": "blue ball"}),
    ("去红色的球", "go_to_object_in_chinese", {"object": "red ball"}),
    ("what do you see", "describe", {}),
    ("你看见什么", "describe_in_chinese", {}),
]

OTHER_TEXTS = [
    "",
    "[unk]",
    "[unk] forward",
    "forward please",
    "turn left ninety",
    "turn left ninety meters",
    "前进九十度",
    "go to the moon",
]

COMMANDS = "commands:\n  ahead:\n    phrases: {phrases}\n    {action}\n"


@pytest.fixture(scope="module")
def commands() -> CommandSet:
    return read_command_file(DEFAULT_FILE)


@pytest.mark.parametrize(("text", "intent", "values"), UNDERSTOOD_TEXTS)
def test_text_matches_command(commands: CommandSet, text: str, intent: str, values: dict[str, object]) -> None:
    match = commands.match_command(text)
    assert match is not None
    assert (match.command.intent, match.values) == (intent, pytest.approx(values) if "angle" in values else values)


@pytest.mark.parametrize("text", OTHER_TEXTS)
def test_unknown_text_matches_no_command(commands: CommandSet, text: str) -> None:
    assert commands.match_command(text) is None


@pytest.mark.parametrize("language", ["en", "zh"])
def test_engine_phrases_match_commands_and_stay_below_limit(commands: CommandSet, language: str) -> None:
    phrases = commands.phrases(language)
    assert [
        text for text in phrases if commands.match_command(text) is None and commands.parse_answer(text) is None
    ] == []
    assert len(phrases) == len(set(phrases)) < 500
    assert {"en": "turn left ninety degrees", "zh": "左转九十度"}[language] in phrases


def test_stop_is_recognized_within_other_words(commands: CommandSet) -> None:
    assert commands.is_stop("[unk] stop")
    assert commands.is_stop("快 停 下")
    assert not commands.is_stop("stopping place")
    assert not commands.is_stop("forward")


def test_yes_and_no_answers_are_recognized(commands: CommandSet) -> None:
    assert [commands.parse_answer(text) for text in ("yes", "是的", "no", "取消", "forward")] == [
        True,
        True,
        False,
        False,
        None,
    ]


def read_commands(text: str) -> CommandSet:
    return parse_commands(SourceText("commands.yaml", text))


def test_action_values_are_numbers_or_slots() -> None:
    phrases = '["go {distance}", "{distance} ahead"]'
    commands_read = read_commands(COMMANDS.format(phrases=phrases, action='drive: {x: 0.5, distance: "{distance}"}'))
    assert commands_read.commands[0].action == Drive(x=0.5, distance=Slot("distance"))


def test_message_template_is_filled_with_slot_values() -> None:
    text = 'publish: {topic: /n, type: std_msgs/msg/String, message: {data: "{number} times"}}'
    action = read_commands(COMMANDS.format(phrases='"ring {number}"', action=text)).commands[0].action
    assert isinstance(action, Publish)
    assert fill_template(action.message, {"number": 3.0}) == {"data": "3 times"}
    assert fill_template({"a": ["{number}", 1]}, {"number": 3.0}) == {"a": [3.0, 1]}


def test_more_specific_phrase_takes_precedence() -> None:
    text = "places: {hall: {x: 1, y: 2, names: [hall, big hall]}}\ncommands:\n"
    text += "  a: {phrases: 'go {place}', go_to: '{place}'}\n"
    commands_read = read_commands(text + "  b: {phrases: go big hall, stop: true}\n")
    match = commands_read.match_command("go big hall")
    assert match is not None
    assert match.command.intent == "b"


@pytest.mark.parametrize(
    ("text", "code", "line", "column", "message"),
    [
        ("places: {}\n", "VOICE302", 1, 1, "'commands' is missing"),
        ("places: {}\ncommands: {}\n", "VOICE302", 2, 11, "there is no command in 'commands'"),
        ("- a\n", "VOICE302", 1, 1, "must be a mapping of keys to values"),
        ("commands: [\n", "VOICE302", 2, 1, "not valid YAML"),
        ("command: {}\n", "VOICE302", 1, 1, "has no 'command'"),
        ("commands:\n  a: {phrases: go}\n", "VOICE302", 2, 6, "has no action"),
        ("commands:\n  a: {stop: true}\n", "VOICE302", 2, 6, "has no 'phrases'"),
        ("commands:\n  a: {phrases: go, stop: true, drive: {x: 1}}\n", "VOICE302", 2, 6, "two actions"),
        (
            "commands:\n  a: {phrases: go, stop: true}\n  a: {phrases: to, stop: true}\n",
            "VOICE302",
            3,
            3,
            "occurs twice",
        ),
        ("commands:\n  a: {phrases: go, drive: {x: fast}}\n", "VOICE302", 2, 31, "'x' must be a number"),
        ("commands:\n  a: {phrases: go, drive: {duration: 2}}\n", "VOICE302", 2, 27, "has no motion"),
        ("commands:\n  a: {phrases: go, drive: {x: 1, angle: 2}}\n", "VOICE302", 2, 41, "'distance'"),
        ("commands:\n  a: {phrases: go, go_to: hall}\n", "VOICE302", 2, 27, "no place 'hall'"),
        (
            "commands:\n  a: {phrases: ['go {distance}', go], drive: {x: 1, distance: '{distance}'}}\n",
            "VOICE302",
            2,
            63,
            "every phrase",
        ),
        ("commands:\n  a: {phrases: 'go {meters}', drive: {x: 1}}\n", "VOICE303", 2, 16, "no slot 'meters'"),
        ("commands:\n  a: {phrases: 'go [ahead', drive: {x: 1}}\n", "VOICE303", 2, 16, "not closed"),
        ("commands:\n  a: {phrases: '{distance}', drive: {x: 1}}\n", "VOICE303", 2, 16, "outside the slots"),
        ("commands:\n  a: {phrases: go, stop: true}\n  b: {phrases: Go, drive: {x: 1}}\n", "VOICE304", 3, 16, "'a'"),
        ("commands:\n  a: {phrases: go, publish: {topic: /a, type: std_msgs/msg/Strin}}\n", "VOICE305", 2, 47, "Strin"),
        (
            "commands:\n  a: {phrases: go, publish: {topic: /a, type: std_msgs/msg/String, message: {text: x}}}\n",
            *("VOICE305", 2, 77, "text"),
        ),
        (
            "said: {angle: [two meters]}\ncommands:\n  a: {phrases: go, stop: true}\n",
            "VOICE302",
            1,
            16,
            "not a value of angle",
        ),
        (
            "commands:\n  a: {phrases: 'a {number} {angle} {distance} {speed} {duration}', drive: {x: 1}}\n",
            *("VOICE306", 1, 1, "phrases are possible"),
        ),
    ],
)
def test_error_in_command_file_is_reported_with_position(
    text: str, code: str, line: int, column: int, message: str
) -> None:
    with pytest.raises(LinkwrightError) as error:
        read_commands(text)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.span is not None
    assert (diagnostic.code, diagnostic.span.line, diagnostic.span.column) == (code, line, column)
    assert message in str(diagnostic.message)


def test_missing_command_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(LinkwrightError) as error:
        read_command_file(tmp_path / "commands.yaml")
    assert error.value.diagnostics[0].code == "VOICE301"
