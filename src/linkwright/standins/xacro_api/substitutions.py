"""Resolve substitution arguments, as in ``xacro.substitution_args``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.standins.xacro_api.errors import XacroException
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault
from linkwright.xacro.session import Inputs


class SubstitutionException(XacroException):
    """Raised when a substitution cannot be resolved."""


class ArgException(SubstitutionException):
    """Raised when an argument is neither set by the caller nor declared with a default."""


def resolve_args(
    arg_str: str | None, context: Mapping[str, Any] | None = None, filename: str | None = None
) -> str | None:
    """Return a string with every ``$(...)`` replaced by its value.

    Args:
        arg_str: the string to resolve; None or an empty string is returned unchanged.
        context: a dictionary with the key ``arg`` for the values of arguments by name.
        filename: the file that contains the string, for ``$(dirname)``.

    Raises:
        ArgException: an argument is missing.
        SubstitutionException: another substitution cannot be resolved.
    """
    if not arg_str:
        return arg_str
    arguments = (context or {}).get("arg", {})
    session = Inputs(filename or "./text", arguments).create_session()
    try:
        return session.evaluate_text(arg_str, Scope(session.globals, session))
    except Fault as fault:
        raise (ArgException if fault.code == "XAC211" else SubstitutionException)(fault.message) from None
