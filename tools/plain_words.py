"""Refuse unusual words in the texts of Linkwright.

Usage: python tools/plain_words.py [PATH ...]

Reads the strings, docstrings and comments of the Python sources and of the page. Prints each text that a pattern of
``plain_words.toml`` matches, with the plain wording, and each exception of the table that no text needs. Exits with 1
if there is one. With paths below ``src/linkwright`` or ``frontend/src``, reads only those.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src" / "linkwright"
PAGE = ROOT / "frontend" / "src"
REFUSED = Path(__file__).with_suffix(".toml")

_SENTENCE_END = re.compile(r"(?<=[.;:!?]) ")
_STRING_OR_COMMENT = re.compile(
    r'''"""(?:[^\\]|\\.)*?"""|\'{3}(?:[^\\]|\\.)*?\'{3}|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|(?P<comment>\#[^\n]*)''',
    re.DOTALL,
)
"""A string or a comment of Python. The module `tokenize` took half of the time of this program."""

_PAGE_TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*"|`(?:[^`\\]|\\.)*`|/\*.*?\*/|//[^\n]*', re.DOTALL)


@dataclass(frozen=True)
class Refusal:
    """A pattern that no text may match.

    Attributes:
        pattern: the words.
        unless: a sentence that this pattern matches, too, is accepted.
        plain: what to write instead.
    """

    pattern: re.Pattern[str]
    unless: re.Pattern[str] | None
    plain: str

    def matches(self, text: str) -> str | None:
        """Return the first refused words of a text, or None."""
        for match in self.pattern.finditer(text):
            sentence = text[_SENTENCE_END.sub("\0", text[: match.start()]).rfind("\0") + 1 :]
            sentence = _SENTENCE_END.split(sentence, maxsplit=1)[0]
            if self.unless is None or not self.unless.search(sentence):
                return match[0]
        return None


@dataclass
class Exemption:
    """Words that stay, such as a text that programs expect from ROS.

    Attributes:
        path: the file, below the folder that has it.
        words: part of the text.
        because: the reason.
        used: whether a text needed the exception.
    """

    path: str
    words: str
    because: str
    used: bool = False

    def covers(self, path: Path, text: str) -> bool:
        """Return whether the exception is for a text of a file."""
        covers = path.as_posix().endswith(self.path) and self.words in text
        self.used = self.used or covers
        return covers


def read_table() -> tuple[list[Refusal], list[Exemption]]:
    """Read the refused patterns and the exceptions."""
    table = tomllib.loads(REFUSED.read_text(encoding="utf-8"))
    refused = [
        Refusal(
            re.compile(row["pattern"], re.IGNORECASE),
            re.compile(row["unless"], re.IGNORECASE) if "unless" in row else None,
            row["plain"],
        )
        for row in table["refused"]
    ]
    return refused, [Exemption(**row) for row in table.get("accepted", [])]


def iterate_python_texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the strings with a space, docstrings and comments of a Python file, with lines."""
    source = path.read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            yield node.lineno, node.value
    for match in _STRING_OR_COMMENT.finditer(source):
        if match["comment"]:
            yield source.count("\n", 0, match.start()) + 1, match["comment"]


def iterate_page_texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the strings with a space and the comments of a TypeScript file, each with its line."""
    source = path.read_text(encoding="utf-8")
    for match in _PAGE_TEXT.finditer(source):
        if " " in match[0]:
            yield source.count("\n", 0, match.start()) + 1, match[0].replace("\n *", " ")


def iterate_texts(roots: list[Path]) -> Iterator[tuple[Path, int, str]]:
    """Yield all texts below some folders: file, line, text."""
    for root in roots:
        for path in [root] if root.is_file() else sorted(root.rglob("*")):
            reader = {".py": iterate_python_texts, ".ts": iterate_page_texts}.get(path.suffix)
            if reader and "zh" not in path.parts and "stubs" not in path.parts:
                yield from ((path, line, text) for line, text in reader(path))


def _is_accepted(exceptions: list[Exemption], path: Path, text: str) -> bool:
    covering = [exception for exception in exceptions if exception.covers(path, text)]
    return bool(covering)


def main(words: list[str]) -> int:
    """Print the refused texts, and return the exit status."""
    refused, accepted = read_table()
    problems = []
    for path, line, text in iterate_texts([Path(word).resolve() for word in words] or [PACKAGE, PAGE]):
        plain = " ".join(text.split())
        refusals = [(match.strip(), refusal.plain) for refusal in refused if (match := refusal.matches(plain))]
        if refusals and not _is_accepted(accepted, path, plain):
            problems += [
                f"{path.relative_to(ROOT)}:{line}: '{match}'; write: {suggestion}" for match, suggestion in refusals
            ]
    if not words:
        problems += [f"{row.path}: no text needs the exception '{row.words}'" for row in accepted if not row.used]
    for problem in problems:
        print(problem)
    return int(bool(problems))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
