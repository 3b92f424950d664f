"""Report how often each rule has findings on robots that work for their authors.

Usage: python tools/rule_survey.py [--sample CODE] FILE|FOLDER...

All rules that are on by default run over each description below the folders. The table lists each code with its number
of findings and the share of robots with such a finding. A rule with findings on many robots is either noise, or detects
a widespread mistake. Errors come first, because nothing that ROS accepts may have an error. ``--sample`` prints
findings of one code, spread over the robots, for manual review. A rule that is right in fewer than nine of ten cases
must be fixed or disabled.
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

_SAMPLE_SIZE = 20


def main() -> None:
    """Print the table, or a sample."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("paths", metavar="FILE|FOLDER", nargs="+", type=Path)
    parser.add_argument("--sample", metavar="CODE", action="append", default=[])
    arguments = parser.parse_args()
    findings = {path: survey_target(path, arguments.paths) for path in list_targets(arguments.paths)}
    if arguments.sample:
        for code in arguments.sample:
            print_sample(findings, code)
    else:
        print_table(findings)


def list_targets(paths: Iterable[Path]) -> list[Path]:
    """Return the descriptions and the folders of packages below some paths."""
    targets = find_targets(paths)
    return [*targets.files, *targets.packages]


def survey_target(path: Path, start: Iterable[Path]) -> list[Diagnostic]:
    """Return the findings about a description or package.

    It may use the packages below the folders `start`.
    """
    finder = PackageFinder(start=[path.absolute().parent, *(folder.absolute() for folder in start)])
    if path.is_dir():
        return list(examine_package(path, Settings(), finder).diagnostics)
    return list(examine(path, packages=finder, settings=Settings()).diagnostics)


def print_table(findings_by_target: dict[Path, list[Diagnostic]]) -> None:
    """Print a line for each code and severity, with the numbers of findings and robots."""
    findings: Counter[tuple[int, str]] = Counter()
    robots: Counter[tuple[int, str]] = Counter()
    order = list(Severity)
    for diagnostics in findings_by_target.values():
        keys = [(order.index(diagnostic.severity), diagnostic.code) for diagnostic in diagnostics]
        findings.update(keys)
        robots.update(set(keys))
    print(f"{len(findings_by_target)} descriptions and packages")
    for key, count in sorted(findings.items(), key=lambda item: (item[0][0], -robots[item[0]])):
        share = robots[key] / len(findings_by_target)
        print(f"{order[key[0]].value:8} {key[1]:9} {count:7} findings on {robots[key]:5} ({share:.0%})")


def print_sample(findings: dict[Path, list[Diagnostic]], code: str) -> None:
    """Print a sample of the findings of a code: one per robot, then the second per robot, ..."""
    matching = [
        [diagnostic for diagnostic in diagnostics if diagnostic.code == code] for diagnostics in findings.values()
    ]
    picked = [of_robot[turn] for turn in range(_SAMPLE_SIZE) for of_robot in matching if len(of_robot) > turn]
    for finding in picked[:_SAMPLE_SIZE]:
        print(
            f"{finding.severity.value}[{finding.code}] {finding.span or '-'}: {finding.message} ({finding.hint or '-'})"
        )


if __name__ == "__main__":
    main()
