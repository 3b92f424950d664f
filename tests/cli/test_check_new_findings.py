"""``check --baseline`` and ``--changed``: only findings that are new."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from tests.repositories import MACRO, PACKAGE, Repository

SEGMENT = "arm_description/urdf/segment.xacro"
FAULTY = MACRO.replace('mass value="2"', 'mass value="-1"')
MOVED = FAULTY.replace("<xacro:macro", "<!-- a\n\n\ncomment -->\n<xacro:macro")
WORSE = MOVED.replace('velocity="1"', 'velocity="0"')


@pytest.fixture
def repository(tmp_path, monkeypatch):
    repository = Repository(tmp_path / "repository")
    repository.commit({**PACKAGE, SEGMENT: FAULTY})
    monkeypatch.chdir(repository.root)
    return repository


@pytest.fixture
def run_check(capsys):
    """Run the command, and return the exit status and the codes of the findings, each once."""

    def run(*words: str) -> tuple[int, set[str]]:
        status = main(["check", "--format", "json", *words])
        return status, {finding["code"] for finding in json.loads(capsys.readouterr().out)["diagnostics"]}

    return run


def test_baseline_hides_known_findings_despite_moved_lines(repository, run_check, capsys):
    _, codes = run_check(".")
    assert codes
    assert main(["check", "--baseline", "known.json", "--write-baseline", "."]) == 0
    assert "to known.json" in capsys.readouterr().err
    assert run_check("--baseline", "known.json", ".") == (0, set())
    repository.write({SEGMENT: MOVED})
    assert run_check("--baseline", "known.json", ".") == (0, set())
    repository.write({SEGMENT: WORSE})
    _, new_codes = run_check("--baseline", "known.json", ".")
    assert new_codes
    assert new_codes.isdisjoint(codes)


def test_baseline_is_identical_in_another_folder(repository, tmp_path):
    main(["check", "--baseline", "known.json", "--write-baseline", "."])
    first = (repository.root / "known.json").read_bytes()
    other = tmp_path / "other"
    repository.root.rename(other)
    main(["check", "--baseline", str(other / "known.json"), "--write-baseline", str(other)])
    assert (other / "known.json").read_bytes() == first
    assert str(tmp_path).encode() not in first


@pytest.mark.parametrize(
    "content", [None, "[", "[]", '{"version": 2, "findings": []}', '{"version": 1, "findings": [1]}']
)
def test_malformed_baseline_is_an_error_and_hides_nothing(repository, capsys, content):
    if content is not None:
        (repository.root / "known.json").write_text(content)
    assert main(["check", "--baseline", "known.json", "."]) == 1
    errors = capsys.readouterr().err
    assert "error[LINT311]" in errors
    assert "--write-baseline" in errors


def test_changed_hides_findings_of_commit(repository, run_check):
    assert run_check("--changed", "HEAD", ".") == (0, set())
    repository.write({SEGMENT: MOVED})
    assert run_check("--changed", "HEAD", ".") == (0, set())
    repository.write({SEGMENT: WORSE})
    _, codes = run_check("--changed", "HEAD", ".")
    assert codes
    repository.commit({SEGMENT: WORSE})
    assert run_check("--changed", "HEAD", ".") == (0, set())
    assert run_check("--changed", "HEAD~1", "arm_description/urdf/arm.urdf.xacro")[1] == codes


def test_changed_matches_findings_of_renamed_file(repository, run_check):
    text = (repository.root / "arm_description/urdf/arm.urdf.xacro").read_text()
    repository.commit({"arm_description/urdf/arm.urdf.xacro": None, "arm_description/urdf/robot.urdf.xacro": text})
    assert run_check("--changed", "HEAD~1", ".") == (0, set())


def test_changed_skips_descriptions_unaffected_by_change(repository, monkeypatch, run_check):
    from linkwright.lint.checking import Checker

    def refuse(*_):
        raise AssertionError("nothing of a robot has changed")

    repository.write({"README.md": "An arm."})
    monkeypatch.setattr(Checker, "check", refuse)
    assert run_check("--changed", "HEAD", ".") == (0, set())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--write-baseline"], "'--write-baseline' needs the file"),
        (["--changed", "HEAD", "--fix"], "'--changed' cannot be combined"),
        (["--changed", "HEAD", "--baseline", "known.json"], "'--changed' cannot be combined"),
    ],
)
def test_contradictory_options_are_rejected(repository, capsys, words, message):
    assert main(["check", *words, "."]) == 2
    assert message in capsys.readouterr().err


def test_changed_rejects_unknown_commit(repository, capsys):
    assert main(["check", "--changed", "nowhere", "."]) == 1
    assert "error[CLI343]" in capsys.readouterr().err


def test_changed_outside_repository_suggests_baseline(tmp_path, monkeypatch, capsys):
    (tmp_path / "a.urdf").write_text("<robot name='a'><link name='a'/></robot>")
    monkeypatch.chdir(tmp_path)
    assert main(["check", "--changed", "HEAD", "a.urdf"]) == 1
    assert "`--baseline`" in capsys.readouterr().err


def test_finding_with_fewer_items_is_not_new(tmp_path):
    from linkwright.diagnostics import Diagnostic
    from linkwright.lint.known_findings import count_keys, find_new_findings

    shorter, longer = Diagnostic("LW848", "not declared: 'a'"), Diagnostic("LW848", "not declared: 'a', 'b'")
    assert find_new_findings([shorter], tmp_path, count_keys([longer], tmp_path)) == []
    assert find_new_findings([longer], tmp_path, count_keys([shorter], tmp_path)) == [longer]
