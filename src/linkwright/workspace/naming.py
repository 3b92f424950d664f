"""Rules for the names and addresses in a package: what the build tools cannot take, and what REP 144 advises.

Errors are what would break a build later (a folder that Python cannot import, a project that CMake refuses, an e-mail
address for which colcon drops the package's environment hooks). Departures from REP 144 are warnings.
"""

from __future__ import annotations

import keyword
import re

from linkwright.diagnostics import Diagnostic, Severity

_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_DEPENDENCY = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")
# An address as catkin_pkg, which colcon asks, accepts it: ASCII, with a top-level domain of two or more letters.
_EMAIL = re.compile(r"[\w%+-]+(\.[\w%+-]+)*@[\w%-]+(\.[\w%-]+)*\.[A-Za-z]{2,}", re.ASCII)


def check_package_name(name: str) -> list[Diagnostic]:
    """What is wrong with the name of a package; errors first (PKG201), or advice (PKG202)."""
    if not _IDENTIFIER.fullmatch(name):
        problem = _broken_rule(name)
        hint = _suggestion(name)
        return [Diagnostic("PKG201", f"'{name}' cannot be the name of a package: {problem}", hint=hint)]
    if keyword.iskeyword(name):
        message = f"'{name}' cannot be the name of a package: it is a word of the Python language"
        return [Diagnostic("PKG201", message, hint=f"did you mean '{name}_robot'?")]
    advice = _departure(name)
    if advice is None:
        return []
    message = f"package name '{name}' does not follow REP 144: {advice}"
    return [Diagnostic("PKG202", message, severity=Severity.WARNING, hint=_suggestion(name))]


def check_member_name(name: str, what: str) -> list[Diagnostic]:
    """What is wrong with the name of a node or library (PKG203); `what` says which."""
    if _IDENTIFIER.fullmatch(name) and not keyword.iskeyword(name):
        return []
    problem = "it is a word of the Python language" if keyword.iskeyword(name) else _broken_rule(name)
    return [Diagnostic("PKG203", f"'{name}' cannot be the name of a {what}: {problem}", hint=_suggestion(name))]


def check_dependency(name: str) -> list[Diagnostic]:
    """What is wrong with the name of a package or system key that is depended on (PKG204)."""
    if _DEPENDENCY.fullmatch(name):
        return []
    message = f"'{name}' cannot be the name of a dependency"
    return [Diagnostic("PKG204", message, hint="separate names with blanks: --dependencies urdf xacro")]


def check_email(address: str) -> list[Diagnostic]:
    """What is wrong with a maintainer's e-mail address (PKG205)."""
    if is_email(address):
        return []
    message = f"'{address}' is not an e-mail address that colcon accepts"
    return [Diagnostic("PKG205", message, hint="write it as name@example.org, in ASCII letters")]


def is_email(address: str) -> bool:
    """Whether colcon takes this for an e-mail address."""
    return _EMAIL.fullmatch(address) is not None


def _broken_rule(name: str) -> str:
    if not name:
        return "it is empty"
    wrong = sorted(set(re.findall(r"[^A-Za-z0-9_]", name)))
    if wrong:
        shown = " ".join("a blank" if character.isspace() else character for character in wrong)
        return f"only letters, digits and underscores may be in it, not {shown}"
    return "it must begin with a letter"


def _departure(name: str) -> str | None:
    if name != name.lower():
        return "names are lower case"
    if "__" in name:
        return "underscores stand alone, not in a row"
    if len(name) < 2:
        return "names have at least two characters"
    return None


def _suggestion(name: str) -> str | None:
    better = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_").lstrip("0123456789_")
    fits = _IDENTIFIER.fullmatch(better) and better != name and _departure(better) is None
    return f"did you mean '{better}'?" if fits else "begin with a letter and go on with letters, digits and underscores"
