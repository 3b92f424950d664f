"""Checks of names and e-mail addresses: the limits of build tools and the rules of REP 144.

Names that would break a build later are errors: a folder that Python cannot import, a project that CMake refuses, an
e-mail address for which colcon drops the package's environment hooks. Deviations from REP 144 are warnings.
"""

from __future__ import annotations

import keyword
import re

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase, quoted, term
from linkwright.loading.deferred import lazy_pattern

_IDENTIFIER = lazy_pattern(r"[A-Za-z][A-Za-z0-9_]*")
# The names that catkin_pkg accepts, including those of old packages.
_PACKAGE_NAME = lazy_pattern(r"[A-Za-z0-9][A-Za-z0-9_-]*")
_DEPENDENCY = lazy_pattern(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")
# The addresses that catkin_pkg, and therefore colcon, accepts: ASCII, with a top-level domain of two or more letters.
_EMAIL = lazy_pattern(r"[\w%+-]+(\.[\w%+-]+)*@[\w%-]+(\.[\w%-]+)*\.[A-Za-z]{2,}", re.ASCII)


def check_package_name(name: str) -> list[Diagnostic]:
    """Return the findings on the name of a package: errors (PKG201), or else warnings (PKG202)."""
    if not _IDENTIFIER.fullmatch(name):
        message = phrase(
            "'{name}' cannot be the name of a package: {problem}", name=name, problem=_find_identifier_problem(name)
        )
        return [Diagnostic("PKG201", message, hint=_suggest_name(name))]
    if keyword.iskeyword(name):
        message = phrase("'{name}' cannot be the name of a package: it is a Python keyword", name=name)
        return [Diagnostic("PKG201", message, hint=phrase("did you mean {names}?", names=quoted(f"{name}_robot")))]
    return [] if _find_rep_144_advice(name) is None else [make_rep_144_warning(name)]


def make_rep_144_warning(name: str) -> Diagnostic:
    """Return the warning (PKG202) with the rule of REP 144 that a name violates."""
    advice = _find_rep_144_advice(name) or _find_identifier_problem(name)
    message = phrase("package name '{name}' does not follow REP 144: {advice}", name=name, advice=advice)
    return Diagnostic("PKG202", message, severity=Severity.WARNING, hint=_suggest_name(name))


def check_member_name(name: str, member_kind: str) -> list[Diagnostic]:
    """Return the findings on the name of a node or library (PKG203).

    Args:
        name: the name of the node or library.
        member_kind: ``node`` or ``library``.
    """
    if _IDENTIFIER.fullmatch(name) and not keyword.iskeyword(name):
        return []
    problem = phrase("it is a Python keyword") if keyword.iskeyword(name) else _find_identifier_problem(name)
    return [
        Diagnostic(
            "PKG203",
            phrase(
                "'{name}' cannot be the name of a {kind}: {problem}", name=name, kind=term(member_kind), problem=problem
            ),
            hint=_suggest_name(name),
        )
    ]


def check_dependency(name: str) -> list[Diagnostic]:
    """Return the findings on the name of a dependency, a package or system key (PKG204)."""
    if _DEPENDENCY.fullmatch(name):
        return []
    message = phrase("'{name}' cannot be the name of a dependency", name=name)
    return [Diagnostic("PKG204", message, hint=phrase("separate names with spaces: --dependencies urdf xacro"))]


def check_email(address: str) -> list[Diagnostic]:
    """Return the findings on a maintainer's e-mail address (PKG205)."""
    if is_email(address):
        return []
    message = phrase("'{address}' is not an e-mail address that colcon accepts", address=address)
    return [Diagnostic("PKG205", message, hint=phrase("write it as name@example.org, in ASCII letters"))]


def is_accepted_name(name: str) -> bool:
    """Return whether colcon accepts a package name, even if REP 144 advises against it."""
    return _PACKAGE_NAME.fullmatch(name) is not None


def is_email(address: str) -> bool:
    """Return whether colcon accepts a text as an e-mail address."""
    return _EMAIL.fullmatch(address) is not None


def _find_identifier_problem(name: str) -> Phrase:
    if not name:
        return phrase("it is empty")
    invalid_characters = sorted(set(re.findall(r"[^A-Za-z0-9_]", name)))
    if invalid_characters:
        character_list = " ".join("a blank" if character.isspace() else character for character in invalid_characters)
        return phrase(
            "it may contain only letters, digits and underscores, not {characters}", characters=character_list
        )
    return phrase("it must begin with a letter")


def _find_rep_144_advice(name: str) -> Phrase | None:
    if name != name.lower():
        return phrase("use lower case")
    if "__" in name:
        return phrase("do not use consecutive underscores")
    if len(name) < 2:
        return phrase("use at least two characters")
    return None


def _suggest_name(name: str) -> Phrase | None:
    suggested_name = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_").lstrip("0123456789_")
    if len(suggested_name) == 1:
        return phrase("choose a longer name, such as {names}", names=quoted(f"{suggested_name}_robot"))
    is_valid = (
        _IDENTIFIER.fullmatch(suggested_name)
        and suggested_name != name
        and _find_rep_144_advice(suggested_name) is None
    )
    return (
        phrase("did you mean {names}?", names=quoted(suggested_name))
        if is_valid
        else phrase("start with a letter, and use only letters, digits and underscores")
    )
