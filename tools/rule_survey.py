"""Say how often each rule fires on robots that their authors are content with.

Usage: python tools/rule_survey.py [--sample CODE] FILE|FOLDER...

All rules that are on by default run over each description below the folders. The table names each code with its
findings and the share of robots that have one: a rule that fires on many is either noise or knows something that the
field does not. Errors come first, since nothing that ROS accepts may have one. ``--sample`` prints findings of one
code, spread over the robots, to be judged by eye; a rule that is right in fewer than nine of ten is to be mended or
switched off.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.lint.engine import examine, examine_package
from linkwright.lint.settings import Settings
from linkwright.lint.targets import find_targets
from linkwright.packages import PackageFinder

_SAMPLE = 20


def main() -> None:
    """Print the table, or a sample."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("paths", metavar="FILE|FOLDER", nargs="+", type=Path)
    parser.add_argument("--sample", metavar="CODE", action="append", default=[])
    arguments = parser.parse_args()
    found = {path: survey_of(path, arguments.paths) for path in targets(arguments.paths)}
    if arguments.sample:
        for code in arguments.sample:
            print_sample(found, code)
    else:
        print_table(found)


def targets(paths: Iterable[Path]) -> list[Path]:
    """The descriptions, and the folders of packages."""
    meant = find_targets(paths)
    return [*meant.files, *meant.packages]


def survey_of(path: Path, start: Iterable[Path]) -> list[Diagnostic]:
    """What the rules say of a description or package, with the packages below the folders at hand."""
    finder = PackageFinder(start=[path.absolute().parent, *(each.absolute() for each in start)])
    if path.is_dir():
        return list(examine_package(path, Settings(), finder).diagnostics)
    return list(examine(path, packages=finder, settings=Settings()).diagnostics)


def print_table(found: dict[Path, list[Diagnostic]]) -> None:
    """A line for each code and severity: how many findings, on how many robots."""
    findings: Counter[tuple[int, str]] = Counter()
    robots: Counter[tuple[int, str]] = Counter()
    order = list(Severity)
    for diagnostics in found.values():
        keys = [(order.index(diagnostic.severity), diagnostic.code) for diagnostic in diagnostics]
        findings.update(keys)
        robots.update(set(keys))
    print(f"{len(found)} descriptions and packages")
    for key, count in sorted(findings.items(), key=lambda item: (item[0][0], -robots[item[0]])):
        print(
            f"{order[key[0]].value:8} {key[1]:9} {count:7} findings on {robots[key]:5} ({robots[key] / len(found):.0%})"
        )


def print_sample(found: dict[Path, list[Diagnostic]], code: str) -> None:
    """Findings of a code, one of each robot before the second of any."""
    mine = [[diagnostic for diagnostic in diagnostics if diagnostic.code == code] for diagnostics in found.values()]
    picked = [each[turn] for turn in range(_SAMPLE) for each in mine if len(each) > turn]
    for each in picked[:_SAMPLE]:
        print(f"{each.severity.value}[{each.code}] {each.span or '-'}: {each.message} ({each.hint or '-'})")


if __name__ == "__main__":
    main()
