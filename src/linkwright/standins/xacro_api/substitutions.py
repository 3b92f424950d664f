"""Substitution arguments as ``xacro.substitution_args`` resolves them for programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.standins.xacro_api.errors import XacroException
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault
from linkwright.xacro.inputs import Inputs


class SubstitutionException(XacroException):
    """A substitution that has no value."""


class ArgException(SubstitutionException):
    """An argument that is neither declared nor given."""


def resolve_args(
    arg_str: str | None, context: Mapping[str, Any] | None = None, filename: str | None = None
) -> str | None:
    """Return a text with every ``$(...)`` replaced.

    Args:
        arg_str: the text; None or an empty one is returned as it is.
        context: ``arg`` in it is name -> value of the arguments.
        filename: the file of the text, to whose folder ``$(dirname)`` refers.

    Raises:
        ArgException: an argument is missing.
        SubstitutionException: another substitution has no value.
    """
    if not arg_str:
        return arg_str
    arguments = (context or {}).get("arg", {})
    session = Inputs(filename or "./text", arguments).session()
    try:
        return session.evaluate_text(arg_str, Scope(session.globals, session))
    except Fault as fault:
        raise (ArgException if fault.code == "XAC211" else SubstitutionException)(fault.message) from None
