"""Apply fixes to files, pass by pass, until no fix is left."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import unified_diff
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Edit, Fix
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.packages import enclosing_package
from linkwright.xmltree import parse
from linkwright.xmltree.reader import read_bytes

_MAX_PASSES = 20
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_XML_SUFFIXES = (".urdf", ".xacro", ".xml")

Check = Callable[[str | None], Iterable[Diagnostic]]
"""A function that checks the main file again, with the given text if it is not None."""


@dataclass(slots=True)
class FixResult:
    """The result of fixing a file.

    Attributes:
        texts: the new text of every file that changes, by path.
        counts: the number of findings that were fixed, by code.
    """

    texts: dict[str, str] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)

    def diff(self) -> str:
        """Return the changes as a unified diff that ``patch -p0`` accepts."""
        return "".join(_make_diff(file, text) for file, text in self.texts.items())


def fix_file(path: Path, check: Check, *, unsafe: bool = False, write: bool = True) -> FixResult:
    """Apply all available fixes to a description.

    Each pass applies the fixes that do not overlap, then the next pass checks the result. Fixes are limited to files of
    the description's package or, if the description is not in a package, to files in and below its folder.

    Args:
        path: the path of the description.
        check: the function that checks the description. If nothing is written, the argument is the new text of `path`
            (None in the first pass), else None.
        unsafe: whether to also apply fixes that may change the meaning.
        write: whether to write the files. If not, the changes are only in the result, and each included file is fixed
            in a single pass.

    Raises:
        LinkwrightError: LINT201 if a file cannot be written.
    """
    allowed_folder = _find_allowed_folder(path)
    result = FixResult()
    for _ in range(_MAX_PASSES):
        findings = check(result.texts.get(str(path)) if not write else None)
        fixed_files = {file for file in result.texts if not write and file != str(path)}
        fixes = [
            (fixable.code, fixable.fix)
            for fixable in _find_fixable_findings(findings, unsafe)
            if _may_change(fixable.fix, allowed_folder, fixed_files)
        ]
        new_texts = _apply_fixes(fixes, result, {} if write else result.texts)
        if not new_texts:
            break
        result.texts.update(new_texts)
        if write:
            for file, text in new_texts.items():
                write_text(Path(file), text)
    return result


def write_text(path: Path, text: str, encoding: str = "utf-8") -> None:
    """Write a file atomically, keeping its permissions and byte order mark.

    If the path is a symbolic link, its target is written.

    Args:
        path: the path of the file.
        text: the new text, without a byte order mark.
        encoding: the encoding of the file.

    Raises:
        LinkwrightError: LINT201 if the file cannot be written.
    """
    try:
        old_content = path.read_bytes()
        write_whole_file(
            path, (_BYTE_ORDER_MARK if old_content.startswith(_BYTE_ORDER_MARK) else b"") + text.encode(encoding)
        )
    except OSError as error:
        message = phrase(
            "cannot write '{path}': {reason}", path=display_path(path), reason=foreign(error.strerror or error)
        )
        raise LinkwrightError(
            Diagnostic("LINT201", message, hint=phrase("check that you have permission to change the file"))
        ) from None


@dataclass(frozen=True, slots=True)
class _FixableFinding:
    code: str
    fix: Fix


def _find_fixable_findings(findings: Iterable[Diagnostic], unsafe: bool) -> Iterator[_FixableFinding]:
    for diagnostic in findings:
        if isinstance(diagnostic, Finding) and diagnostic.fix and (diagnostic.fix.safe or unsafe):
            yield _FixableFinding(diagnostic.code, diagnostic.fix)


def _find_allowed_folder(path: Path) -> Path:
    folder = path.absolute().parent
    package = enclosing_package(folder)
    return (package[1] if package else folder).resolve()


def _may_change(fix: Fix, allowed_folder: Path, fixed_files: set[str]) -> bool:
    return all(
        edit.source_file not in fixed_files and Path(edit.source_file).resolve().is_relative_to(allowed_folder)
        for edit in fix.edits
    )


def _apply_fixes(fixes: Iterable[tuple[str, Fix]], result: FixResult, texts: Mapping[str, str]) -> dict[str, str]:
    """Return the new text of each file that the fixes change, by path.

    Of overlapping fixes, the first is applied. The result is empty if one of the files cannot be read. A file whose new
    text would not be well-formed XML is left out.
    """
    accepted_edits: dict[str, list[Edit]] = {}
    counts: dict[str, int] = {}
    old_texts: dict[str, str | None] = {}
    for code, fix in fixes:
        if all(_is_separate(edit, accepted_edits.get(edit.source_file, ())) for edit in fix.edits):
            for edit in fix.edits:
                accepted_edits.setdefault(edit.source_file, []).append(edit)
            counts[code] = counts.get(code, 0) + 1
    new_texts = {}
    for file, edits in accepted_edits.items():
        text = old_texts.setdefault(file, texts.get(file) if file in texts else _read_text(file))
        if text is None:
            return {}
        new_text = _apply_edits(text, edits)
        if new_text != text and _is_well_formed(file, new_text):
            new_texts[file] = new_text
    if new_texts:
        for code, count in counts.items():
            result.counts[code] = result.counts.get(code, 0) + count
    return new_texts


def _is_separate(edit: Edit, others: Iterable[Edit]) -> bool:
    return all(edit.end < other.start or other.end < edit.start for other in others)


def _apply_edits(text: str, edits: Iterable[Edit]) -> str:
    for edit in sorted(edits, key=lambda edit: edit.start, reverse=True):
        text = text[: edit.start] + edit.replacement + text[edit.end :]
    return text


def _read_text(file: str) -> str | None:
    """Return the text of a file without a byte order mark, or None if it is not readable UTF-8."""
    try:
        return read_bytes(file).removeprefix(_BYTE_ORDER_MARK).decode("utf-8")
    except (LinkwrightError, UnicodeDecodeError):
        return None


def _is_well_formed(file: str, text: str) -> bool:
    if not file.endswith(_XML_SUFFIXES):
        return True
    try:
        parse(text.lstrip(), file)
    except LinkwrightError:
        return False
    return True


def _make_diff(file: str, text: str) -> str:
    return make_unified_diff(display_path(file), _read_text(file) or "", text)


def make_unified_diff(name: str, before: str, after: str) -> str:
    """Return the changes to a file as a unified diff that ``patch -p0`` accepts."""
    lines = unified_diff(before.splitlines(keepends=True), after.splitlines(keepends=True), name, name)
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines)
