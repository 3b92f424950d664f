"""The short forms of command-line options, and the options of click."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

PATH = "arm/scripts/plan.py"
ARGPARSE = "import argparse\nparser = argparse.ArgumentParser()\nparser.add_argument({})\n"
CLICK = "import click\n\n\n@click.command()\n@click.option({})\ndef main(rate):\n    pass\n"
OTHER = "import menu\n\n\n@menu.option({})\ndef main(rate):\n    pass\n"


@pytest.mark.parametrize(
    ("text", "old", "new", "expected", "reason"),
    [
        (ARGPARSE, "'-r', '--rate'", "'--rate'", "command-line option '--rate': short form -r -> -",
         "callers that pass '-r' get an error"),
        (ARGPARSE, "'--rate'", "'-r', '--rate'", "command-line option '--rate': short form - -> -r", "None"),
        (CLICK, "'--rate', '-r', 'rate_hz'", "'--rate', 'rate_hz'", "command-line option '--rate': short form -r -> -",
         "callers that pass '-r' get an error"),
        (CLICK, "'--rate'", "'--hertz'", "command-line option '--rate' renamed to '--hertz'",
         "callers that pass '--rate' get an error"),
        (CLICK, "'--rate'", "'--rate', required=True", "command-line option '--rate': required no -> yes",
         "callers that do not pass '--rate' get an error"),
    ],
)  # fmt: skip
def test_changed_option_of_a_script(repository, compare, text, old, new, expected, reason):
    repository.commit({PATH: text.format(old)})
    repository.write({PATH: text.format(new)})
    changes = subject(compare(repository), PATH).changes
    assert (expected, reason) in [(str(change.sentence), str(change.reason)) for change in changes]


def test_option_of_another_library_is_not_one_of_the_command_line(repository, compare):
    repository.commit({PATH: OTHER.format("'--rate'")})
    repository.write({PATH: OTHER.format("'--hertz'")})
    lines = sentences(subject(compare(repository), PATH))
    assert not any(line.startswith("command-line option") for line in lines)


@pytest.mark.parametrize(("statement", "is_lost"), [("import train", False), ("import os", True)])
def test_option_that_another_program_has_is_lost_unless_it_is_imported(repository, compare, statement, is_lost):
    program = ARGPARSE.format("'--rate'") + "\n\ndef main():\n    parser.parse_args()\n"
    repository.commit({PATH: f"{statement}\n{program}", "arm/scripts/train.py": "RATE = 1\n"})
    repository.write({PATH: f"{statement}\n\n\ndef main():\n    pass\n", "arm/scripts/train.py": program})
    lines = sentences(subject(compare(repository), PATH)) if is_lost else []
    assert ("command-line options removed: '--rate'" in lines) is is_lost
    assert is_lost or not any("options removed" in str(change) for _, change in compare(repository).breaking_changes)


@pytest.mark.parametrize(
    ("beginning", "is_compared"),
    [
        ("#!/usr/bin/env python3\nimport argparse\n", True),
        ("import argparse\n", False),
        ("#!/usr/bin/env python3\nimport argparse\nimport unittest\n", False),
        ("#!/usr/bin/env python3\nimport argparse\ndef test_speed():\n    pass\n", False),
    ],
)
def test_program_whose_name_begins_like_that_of_a_test(repository, compare, beginning, is_compared):
    path, option = "arm/scripts/test_speed.py", "parser.add_argument('--speed')\n"
    repository.commit({path: beginning})
    repository.write({path: beginning + option})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert any("'--speed'" in line for line in lines) == is_compared


def test_reason_for_several_options_quotes_each(repository, compare):
    options = "parser.add_argument('--port')\nparser.add_argument('--speed')\n"
    repository.commit({PATH: ARGPARSE.format("'--rate'") + options})
    repository.write({PATH: ARGPARSE.format("'--rate'")})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "callers that pass '--port', '--speed' get an error"
