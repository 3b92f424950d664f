"""The command `linkwright`: subcommands, usage, exit statuses, and no traceback."""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Iterator

import pytest

from linkwright import __version__
from linkwright.cli import main
from linkwright.cli.command import collect_help_texts, create_parser
from linkwright.diagnostics.translation import set_language


def test_missing_arguments_print_overview_as_usage(capsys):
    assert main([]) == 2
    printed = capsys.readouterr().out
    assert all(verb in printed for verb in collect_help_texts())


def test_help_lists_every_command(capsys):
    assert main(["--help"]) == 0
    printed = capsys.readouterr().out
    assert all(f"  {verb} " in printed for verb in collect_help_texts())


def test_version_is_printed(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"linkwright {__version__}\n"


def test_unknown_command_suggests_nearest(capsys):
    assert main(["xarco"]) == 2
    assert capsys.readouterr().err == "linkwright: there is no command 'xarco'; did you mean 'xacro'?\n"


@pytest.mark.parametrize(
    ("words", "suggestion"),
    [
        (["--vesion"], "--version"),
        (["check", "r.urdf", "--strct"], "--strict"),
        (["topic", "echo", "/x", "--onec"], "--once"),
        (["view", "r.urdf", "--prot=7500"], "--port"),
        (["--lang", "zh", "check", "r.urdf", "--strct"], "--strict"),
    ],
)
def test_misspelled_option_suggests_nearest(words, suggestion, capsys):
    assert main(words) == 2
    assert suggestion in capsys.readouterr().err.splitlines()[-1].rpartition(";")[2]


@pytest.mark.parametrize("verb", collect_help_texts())
def test_every_command_has_help(verb, capsys):
    assert main([verb, "--help"]) == 0
    assert f"usage: linkwright {verb}" in capsys.readouterr().out


def test_unknown_option_is_usage_error(capsys):
    assert main(["xacro", "--nonsense", "a.xacro"]) == 2
    assert "--nonsense" in capsys.readouterr().err


@pytest.mark.parametrize("verb", ["check", "view", "xacro", "inertia", "diagram"])
def test_missing_file_argument_is_named(verb, capsys):
    with pytest.raises(SystemExit):
        create_parser(verb).parse_args([])
    assert "the following arguments are required: FILE" in (printed := capsys.readouterr().err)
    assert printed.rstrip().endswith(("FILE", "FILE|FOLDER|NAME:=VALUE"))


def test_internal_error_is_reported_without_traceback(monkeypatch, capsys):
    def broken(*_words):
        raise ZeroDivisionError("seeded")

    monkeypatch.setattr("linkwright.cli.command._dispatch", broken)
    assert main(["xacro", "x"]) == 3
    err = capsys.readouterr().err
    assert "ZeroDivisionError: seeded" in err
    assert "Traceback" not in err
    log = err.rsplit(" ", 1)[1].strip()
    with open(log, encoding="utf-8") as file:  # noqa: PTH123 - the name is printed text
        assert "Traceback" in file.read()


def test_interrupt_exits_with_130(monkeypatch):
    def interrupted(*_words):
        raise KeyboardInterrupt

    monkeypatch.setattr("linkwright.cli.command._dispatch", interrupted)
    assert main(["xacro", "x"]) == 130


def test_closed_pipe_is_not_an_error(tmp_path):
    model = tmp_path / "long.urdf"
    links = "".join(f'<link name="l{number}"/>' for number in range(20000))
    model.write_text(f'<robot name="r">{links}</robot>')
    command = f"{sys.executable} -m linkwright xacro {model} | head -n 1"
    result = subprocess.run(["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False)
    assert result.stdout == '<?xml version="1.0" ?>\n'
    assert result.stderr == ""


def test_garbage_collector_skips_startup_imports():
    program = (
        "import gc, sys\n"
        "sys.argv[1:] = ['--version']\n"
        "from linkwright.cli import main\n"
        "main()\n"
        "print(gc.get_threshold()[0])\n"
        "gc.collect()\n"
        "print(gc.get_threshold()[0])\n"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    first, later = map(int, result.stdout.split()[-2:])
    assert first > later > 700


def texts_in(parser: argparse.ArgumentParser) -> Iterator[str]:
    """Return the texts of a parser and its subparsers: descriptions, groups and arguments."""
    yield from filter(None, [parser.description, *(group.title for group in parser._action_groups)])
    for action in parser._actions:
        if action.help and action.help != argparse.SUPPRESS:
            yield action.help
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                yield from texts_in(below)


@pytest.mark.parametrize("verb", collect_help_texts())
def test_command_help_is_fully_translated(verb):
    set_language("en")
    try:
        english = list(texts_in(create_parser(verb)))
        set_language("zh")
        chinese = list(texts_in(create_parser(verb)))
    finally:
        set_language(None)
        create_parser(verb)  # restore argparse's English texts
    assert [text for text, translation in zip(english, chinese, strict=True) if text == translation] == []
