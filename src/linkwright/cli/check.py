"""``linkwright check``: check robots and worlds, and print their structure and findings."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import SimpleNamespace

from linkwright.cli.exit_status import print_message
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    counted,
    has_errors,
    phrase,
    print_diagnostics,
)
from linkwright.diagnostics.alike import group_similar
from linkwright.diagnostics.formats import FORMATS, format_diagnostics
from linkwright.diagnostics.translation import localized
from linkwright.loading.lean_typing import TYPE_CHECKING, Any
from linkwright.process.assignments import parse_assignments

if TYPE_CHECKING:
    import argparse

    from linkwright.lint.apply import FixResult
    from linkwright.lint.checking import Checker
    from linkwright.lint.engine import Checked


_USAGE_ERROR = 2
_DEFAULTS: dict[str, Any] = {
    "all": False,
    "baseline": None,
    "changed": None,
    "config": None,
    "diff": False,
    "fix": False,
    "format": "text",
    "ignore": None,
    "package": False,
    "select": None,
    "statistics": False,
    "strict": False,
    "unsafe_fixes": False,
    "write_baseline": False,
}
"""The values of options that the user does not pass."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``check``."""
    parser.add_argument(
        "words",
        metavar="FILE|FOLDER|NAME:=VALUE",
        nargs="+",
        help="URDF, xacro and SDF files, launch files and other files of packages, folders to search for "
        "descriptions, worlds and packages, and values for the files' <xacro:arg>",
    )
    parser.add_argument(
        "--package",
        action="store_true",
        help="also check the packages that contain the files, as for folders",
    )
    parser.add_argument("--all", action="store_true", help="print every finding, not only the first of similar ones")
    parser.add_argument("--format", choices=FORMATS, help="the output format (default: text)")
    parser.add_argument("--strict", action="store_true", help="exit with status 1 also for warnings")
    parser.add_argument(
        "--select", metavar="RULES", action="append", help="report only these rules, such as LW2,axis-zero"
    )
    parser.add_argument("--ignore", metavar="RULES", action="append", help="do not report these rules")
    parser.add_argument(
        "--config", metavar="FILE", help="the settings file to use instead of the nearest linkwright.toml"
    )
    parser.add_argument(
        "--changed",
        metavar="COMMIT",
        help="check only the descriptions and packages that the changes since a git commit "
        "affect, and report only new findings",
    )
    parser.add_argument(
        "--baseline",
        metavar="FILE",
        help="do not report the findings that this file lists, such as those of an old package",
    )
    parser.add_argument("--write-baseline", action="store_true", help="write all findings to the file of --baseline")
    parser.add_argument("--statistics", action="store_true", help="print the number of findings for each code")
    parser.add_argument("--fix", action="store_true", help="apply safe fixes to the files")
    parser.add_argument("--unsafe-fixes", action="store_true", help="also apply fixes that may change the meaning")
    parser.add_argument("--diff", action="store_true", help="print the changes of the fixes without writing them")
    parser.set_defaults(**_DEFAULTS)


def parse_without_options(words: list[str]) -> SimpleNamespace | None:
    """Return the parsed arguments of a command line without options.

    The result is None if the command line is empty.
    """
    return SimpleNamespace(words=words, **_DEFAULTS) if words else None


def run(arguments: argparse.Namespace | SimpleNamespace) -> int:
    """Check the files, and return 1 if there are errors, or warnings with ``--strict``.

    The tree and machine-readable findings are written to standard output, findings as text to standard error.
    """
    paths = [Path(word) for word in arguments.words if ":=" not in word]
    if not paths:
        return _report_usage_error("pass a file or folder to check")
    select = None if arguments.select is None else _split_selectors(arguments.select)
    ignore = _split_selectors(arguments.ignore or ())
    usage_error = _unknown_selector_error((*(select or ()), *ignore))
    if usage_error:
        return _report_usage_error(usage_error)
    if arguments.config is not None and not Path(arguments.config).is_file():
        return _report_usage_error(phrase("no such file: '{path}'", path=arguments.config))

    from linkwright.lint.checking import Checker

    checker = Checker(
        parse_assignments(word for word in arguments.words if ":=" in word),
        select,
        ignore,
        None if arguments.config is None else Path(arguments.config),
        tuple(path.absolute() for path in paths if path.is_dir()),
    )
    conflict = _find_option_conflict(arguments)
    if conflict is not None:
        return _report_usage_error(conflict)
    fix_results: list[FixResult] = []
    if arguments.diff or arguments.fix or arguments.unsafe_fixes:
        fix_results = _apply_fixes(
            paths,
            checker,
            with_packages=arguments.package,
            unsafe=arguments.unsafe_fixes,
            write=not arguments.diff,
        )
    if arguments.diff:
        return _print_diff(fix_results)
    if arguments.changed is None:
        diagnostics, checked_file = _find_and_check(paths, checker, with_packages=arguments.package)
    else:
        diagnostics, checked_file = _check_changed(paths, checker, arguments), None
    if arguments.baseline is not None:
        if arguments.write_baseline:
            return _write_baseline(arguments.baseline, diagnostics)
        diagnostics = _remove_baseline_findings(arguments.baseline, diagnostics)
    _print_findings(diagnostics, arguments.format, show_all=arguments.all)
    if arguments.format == "text":
        if checked_file is not None:
            sys.stdout.write(_format_contents(checked_file))
        _summarize(diagnostics, fix_results)
    if arguments.statistics:
        _print_statistics(diagnostics)
    failed = has_errors(diagnostics) or (
        arguments.strict and any(diagnostic.severity is Severity.WARNING for diagnostic in diagnostics)
    )
    return 1 if failed else 0


def _format_contents(checked_file: Checked) -> str:
    """Return a robot's tree of links, a world's list of models, or an empty string."""
    if checked_file.robot is not None:
        from linkwright.urdf import tree_text

        return tree_text(checked_file.robot)
    if checked_file.sdf is not None:
        from linkwright.sdf.listing import list_contents

        return list_contents(checked_file.sdf)
    return ""


def _find_and_check(
    paths: Sequence[Path], checker: Checker, *, with_packages: bool
) -> tuple[list[Diagnostic], Checked | None]:
    """Return all findings without duplicates, and the parsed file if the only path is a file.

    Raises:
        LinkwrightError: CLI302, the paths contain nothing to check.
    """
    from linkwright.lint.targets import find_targets

    targets = find_targets(paths, with_packages=with_packages)
    if not targets.files and not targets.packages:
        path_list = ", ".join(f"'{path}'" for path in paths)
        hint = phrase(
            "descriptions are .urdf, .sdf and .world files, and .xacro files with <robot name=...> that no other file"
            " includes; launch files and parameter files are checked in a package, which has a package.xml"
        )
        raise LinkwrightError(
            Diagnostic("CLI302", phrase("there is nothing to check in {named}", named=path_list), hint=hint)
        )
    diagnostics, checked_file = checker.check(targets, paths)
    return diagnostics, checked_file if len(paths) == 1 and not paths[0].is_dir() else None


def _find_option_conflict(arguments: argparse.Namespace | SimpleNamespace) -> Phrase | None:
    """Return why options contradict each other, or None if they do not."""
    if arguments.write_baseline and arguments.baseline is None:
        return phrase("'--write-baseline' needs the file: '--baseline FILE'")
    if arguments.changed is not None and (arguments.baseline is not None or arguments.fix or arguments.unsafe_fixes):
        return phrase("'--changed' cannot be combined with '--baseline' or fixes")
    return None


def _check_changed(
    paths: Sequence[Path], checker: Checker, arguments: argparse.Namespace | SimpleNamespace
) -> list[Diagnostic]:
    """Return the findings that a commit does not have.

    Raises:
        LinkwrightError: CLI341 to CLI346, git cannot find or read the commit.
    """
    from linkwright.lint.changed_since import WorkingTreeChanges
    from linkwright.lint.known_findings import find_new_findings

    changed = WorkingTreeChanges(paths, arguments.changed, with_packages=arguments.package)
    targets = changed.targets()
    if not targets.files and not targets.packages:
        return []
    diagnostics = checker.check(targets, paths)[0]
    known_counts = changed.known_findings(lambda targets, paths: checker.for_folders(paths).check(targets, paths)[0])
    return find_new_findings(diagnostics, changed.root, known_counts)


def _remove_baseline_findings(file: str, diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the findings that a baseline does not list.

    Raises:
        LinkwrightError: LINT311, the file cannot be read or is not a baseline.
    """
    from linkwright.lint.known_findings import find_new_findings, read_baseline

    return find_new_findings(diagnostics, Path(file).absolute().parent, read_baseline(Path(file)))


def _write_baseline(file: str, diagnostics: Sequence[Diagnostic]) -> int:
    """Write a baseline and print the number of findings.

    Raises:
        LinkwrightError: CLI201, the file cannot be written.
    """
    from linkwright.cli.output import write_error
    from linkwright.lint.known_findings import write_baseline

    path = Path(file)
    try:
        count = write_baseline(path, diagnostics, path.absolute().parent)
    except OSError as error:
        raise write_error(path, error) from None
    findings_text = counted("{count} finding", "{count} findings", count)
    print_message(localized(phrase("wrote {findings} to {path}", findings=findings_text, path=file)))
    return 0


def _unknown_selector_error(words: Iterable[str]) -> str | None:
    """Return the usage error for the first selector that matches no rule, or None."""
    from linkwright.lint.selector_words import is_selector, make_selector_hint

    for selector in words:
        if not is_selector(selector):
            return f"there is no rule '{selector}'; {make_selector_hint(selector)}"
    return None


def _apply_fixes(
    paths: Sequence[Path], checker: Checker, *, with_packages: bool, unsafe: bool, write: bool
) -> list[FixResult]:
    from linkwright.lint.apply import fix_file
    from linkwright.lint.targets import find_targets
    from linkwright.packages.manifest import MANIFEST
    from linkwright.xmltree import Overlay

    def recheck_file(file: Path, text: str | None) -> Iterable[Diagnostic]:
        overlay = None if text is None else Overlay({file: text})
        return checker.check_file(file, targets, overlay)[0].diagnostics

    def recheck_package(folder: Path, text: str | None) -> Iterable[Diagnostic]:
        overlay = None if text is None else Overlay({folder / MANIFEST: text})
        return targets.select(folder, checker.check_package(folder, overlay)[0])

    targets = find_targets(paths, with_packages=with_packages)
    checks = [(file, partial(recheck_file, file)) for file in targets.files]
    checks += [(folder / MANIFEST, partial(recheck_package, folder)) for folder in targets.packages]
    return [fix_file(path, check, unsafe=unsafe, write=write) for path, check in checks]


def _print_diff(fix_results: Sequence[FixResult]) -> int:
    printed_files: set[str] = set()
    for result in fix_results:
        result.texts = {file: text for file, text in result.texts.items() if file not in printed_files}
        printed_files.update(result.texts)
        sys.stdout.write(result.diff())
    return 1 if printed_files else 0


def _print_findings(diagnostics: Sequence[Diagnostic], format_name: str, *, show_all: bool) -> None:
    if format_name == "text":
        with suppress(OSError):  # a failure to write must not change the exit status, as in `print_message`
            print_diagnostics(diagnostics if show_all else group_similar(diagnostics), sys.stderr)
    else:
        sys.stdout.write(format_diagnostics(diagnostics, format_name))


def _summarize(diagnostics: Sequence[Diagnostic], fix_results: Sequence[FixResult]) -> None:
    if fix_results:
        count = sum(sum(fix_result.counts.values()) for fix_result in fix_results)
        files = len({file for fix_result in fix_results for file in fix_result.texts})
        line = phrase(
            "fixed {findings} in {files}",
            findings=counted("{count} finding", "{count} findings", count),
            files=counted("{count} file", "{count} files", files),
        )
        print_message(localized(line))
    errors = sum(diagnostic.severity is Severity.ERROR for diagnostic in diagnostics)
    warnings = sum(diagnostic.severity is Severity.WARNING for diagnostic in diagnostics)
    line = phrase(
        "{errors}, {warnings}",
        errors=counted("{count} error", "{count} errors", errors),
        warnings=counted("{count} warning", "{count} warnings", warnings),
    )
    print_message(localized(line))


def _print_statistics(diagnostics: Iterable[Diagnostic]) -> None:
    from linkwright.lint.explain import find_page

    for code, count in sorted(
        Counter(diagnostic.code for diagnostic in diagnostics).items(), key=lambda item: (-item[1], item[0])
    ):
        page = find_page(code)
        print(f"{count:6}  {code:<9} {page.name or localized(page.title) if page else ''}".rstrip(), file=sys.stderr)


def _split_selectors(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for word in words for name in word.replace(",", " ").split())


def _report_usage_error(message: str) -> int:
    print(f"linkwright check: {message}", file=sys.stderr)
    return _USAGE_ERROR
