"""``linkwright review``: report the effects of commits on robots, worlds and launch files."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINDINGS, FINE, USAGE
from linkwright.cli.numbers import positive_int
from linkwright.cli.output import write_output
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.diagnostics.formats import format_diagnostics
from linkwright.process.processors import usable_processors

if TYPE_CHECKING:
    from linkwright.review import Review
    from linkwright.review.versions import Version

_CONDITIONS: dict[str, Callable[[Review], object]] = {
    "breaking": lambda review: review.breaking_changes,
    "findings": lambda review: review.new_findings,
    "problems": lambda review: [
        subject
        for subject in review.subjects
        if subject.is_lost or not all(problem.is_of_old for problem in subject.problems)
    ],
    "changes": lambda review: review.subjects,
}
"""The values of ``--fail-on``, and what makes the command fail."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``review``."""
    parser.add_argument(
        "words",
        metavar="RANGE|PACKAGE",
        nargs="*",
        help="the commits, as OLD..NEW, OLD...NEW (since the last common commit) or OLD (compared with the working "
        "tree), by default those since the default branch; then the names or folders of the packages to review, by "
        "default all",
    )
    parser.add_argument(
        "--repository",
        metavar="FOLDER",
        type=Path,
        default=Path(),
        help="a folder of the repository (default: this one)",
    )
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write a comment for a pull request")
    parser.add_argument("--html", metavar="FILE", type=Path, help="write a page that needs no other file")
    parser.add_argument(
        "--scenes",
        action="store_true",
        help="add scenes in 3D to the page, with both versions of a robot over each other; the page grows by half a "
        "megabyte and by the meshes",
    )
    parser.add_argument("--json", metavar="FILE", type=Path, help="write all changes and findings for programs")
    parser.add_argument(
        "--sarif", metavar="FILE", type=Path, help="write the breaking changes and new findings for code scanning"
    )
    parser.add_argument(
        "--github", action="store_true", help="print them as annotations of GitHub Actions instead of the report"
    )
    parser.add_argument(
        "--fail-on",
        metavar="CONDITION,...",
        type=_parse_conditions,
        default=(),
        help="exit with status 1 for: breaking (changes), findings (new ones), problems (files that cannot be "
        "compared), changes (any)",
    )
    parser.add_argument(
        "--scenario",
        metavar="FILE",
        action="append",
        default=[],
        help="run this scenario of `linkwright sweep` in both versions, which executes their "
        "code, and compare the results and the paths of the robots",
    )
    parser.add_argument(
        "--seeds", metavar="N", type=positive_int, help="the number of seeds of scenarios (default: their own)"
    )
    parser.add_argument(
        "--workers",
        metavar="N",
        type=positive_int,
        help="the number of parallel processes (default: one for each processor)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the report, and return 1 if a condition of ``--fail-on`` is met."""
    from linkwright.review import open_versions, review

    if arguments.scenes and arguments.html is None:
        print("linkwright review: --scenes needs a page for the scenes: --html FILE", file=sys.stderr)
        return USAGE
    range_text, packages = _split_words(arguments.words, arguments.repository)
    versions = open_versions(arguments.repository, range_text)
    try:
        scenarios = [_to_repository_path(file, versions.new) for file in arguments.scenario]
        workers = arguments.workers or usable_processors()
        has_page = arguments.html is not None
        images = {"with_images": has_page, "with_scenes": has_page and arguments.scenes}
        result = review(versions, packages, workers, scenarios, arguments.seeds, **images)
    finally:
        versions.close()
    _write_report(result, arguments)
    return FINDINGS if any(_CONDITIONS[name](result) for name in arguments.fail_on) else FINE


def _parse_conditions(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in _CONDITIONS:
            raise argparse.ArgumentTypeError(f"'{name}' is not one of {', '.join(_CONDITIONS)}")
    return names


def _split_words(words: Sequence[str], folder: Path) -> tuple[str, Sequence[str]]:
    """Return the range of commits and the packages.

    The first word is a package if it is a folder or does not name a commit.
    """
    if not words or ".." in words[0]:
        return (words[0], words[1:]) if words else ("", ())
    from linkwright.review import names_commit

    is_range = not (folder / words[0]).is_dir() and names_commit(folder, words[0])
    return (words[0], words[1:]) if is_range else ("", words)


def _to_repository_path(file: str, version: Version) -> str:
    """Return the path of a scenario relative to the root of the repository.

    Raises:
        LinkwrightError: REV104, there is no such file.
    """
    path = version.relative(file) if Path(file).is_file() else None
    if path is None and version.file(file).is_file():
        path = file
    if path is None:
        message = phrase("the new version has no scenario '{file}'", file=file)
        hint = phrase("pass a Python file of the repository with a function decorated with @scenario(...)")
        raise LinkwrightError(Diagnostic("REV104", message, hint=hint))
    return path


def _write_report(review: Review, arguments: argparse.Namespace) -> None:
    """Write the files that the arguments name, and print the report.

    Raises:
        LinkwrightError: CLI201, a file cannot be written.
    """
    from linkwright.review.reports import as_data, as_diagnostics, as_html, as_markdown, as_text

    if arguments.markdown is not None:
        write_output(arguments.markdown, as_markdown(review))
    if arguments.html is not None:
        write_output(arguments.html, as_html(review))
    if arguments.json is not None:
        write_output(arguments.json, json.dumps(as_data(review), indent=2, ensure_ascii=False) + "\n")
    if arguments.sarif is not None:
        write_output(arguments.sarif, format_diagnostics(as_diagnostics(review), "sarif"))
    sys.stdout.write(format_diagnostics(as_diagnostics(review), "github") if arguments.github else as_text(review))
