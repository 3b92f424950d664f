"""Convert a Python 2 source so that the parser of Python 3 accepts it, with the same lines."""

from __future__ import annotations

import re

from linkwright.loading.deferred import lazy_pattern

_TOKEN = lazy_pattern(
    r"""(?P<text>[rRbBuU]{0,2}(?:'{3}.*?(?<!\\)'{3}|\"{3}.*?(?<!\\)\"{3}|'(?:\\.|[^'\\\n])*'|\"(?:\\.|[^\"\\\n])*\"))
    |(?P<comment>\#[^\n]*)|(?P<line>\\\n)|(?P<end>\n)|(?P<word>[A-Za-z_]\w*)
    |(?P<number>0[xX]\w+|\.?\d(?:[eE][+-]?(?=\d)|[\w.])*)|(?P<unequal><>)|(?P<quote>`)|(?P<other>.)""",
    re.VERBOSE | re.DOTALL,
)
_OCTAL = lazy_pattern(r"0[0-7]+[lL]?")


def as_python3(text: str) -> str:
    """Return a source with the statements of Python 2 replaced, so that it can be parsed.

    Statements that print or execute become ``pass``. All other names and texts keep their lines.
    """
    text = "\n".join(_expand_tabs(line) for line in text.splitlines()) + "\n"
    parts: list[str] = []
    statement: str = ""  # the first word of the statement
    depth, is_dropped, is_start = 0, False, True
    for match in _TOKEN.finditer(text):
        kind, part = match.lastgroup, match[0]
        if kind == "word" and is_start:
            statement = part
            is_dropped = part in ("print", "exec") and _is_statement(text, match.end())
            part = "pass" if is_dropped else part
        elif kind == "other" and part in "([{":
            depth += 1
        elif kind == "other" and part in ")]}":
            depth = max(0, depth - 1)
        ends = depth == 0 and (kind == "end" or part in ";:")
        if ends:
            is_dropped, statement = False, ""
        elif is_dropped and not is_start:
            part = re.sub(r"[^\n]", " ", part)
        elif depth == 0 and part == "," and statement in ("except", "raise"):
            is_dropped, part = True, " "
        else:
            part = _replace_statement(str(kind), part)
        is_start = ends or (is_start and not part.strip())
        parts.append(part)
    return "".join(parts)


def _expand_tabs(line: str) -> str:
    """Return a line with spaces for tabs in the indentation.

    A tab in Python 2 advances to a multiple of eight columns.
    """
    content = line.lstrip(" \t\f")
    return line[: len(line) - len(content)].expandtabs(8) + content


def _is_statement(text: str, end: int) -> bool:
    """Return whether the word before an offset begins a Python 2 statement.

    Otherwise, it is called or assigned.
    """
    following = text[end:].lstrip(" \t")
    return not following.startswith(("=", ".")) or following.startswith("==")


def _replace_statement(kind: str, part: str) -> str:
    if kind == "number" and _OCTAL.fullmatch(part):
        return part.replace("0", " ", 1).rstrip("lL") if part.strip("0lL") else "0"
    if kind == "number":
        return part.rstrip("lL") if not part.startswith("0x") else part.rstrip("L")
    if kind == "unequal":
        return "!="
    if kind == "quote":
        return " "
    if kind == "text" and part[:2].lower() == "ur":
        return part[1:]
    return part
