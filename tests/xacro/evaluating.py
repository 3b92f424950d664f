"""Evaluating single texts in tests."""

from __future__ import annotations

from typing import Any

from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.limits import Limits, recursion_limit_for
from linkwright.xacro.session import Session


def evaluate(text: str, limits: Limits | None = None, **properties: Any) -> Any:
    """The value of a text that sees some properties."""
    limits = limits or Limits()
    session = Session("main.xacro", {}, {}, limits)
    scope = Scope(session.globals, session, dict(properties))
    with recursion_limit_for(limits):
        return session.evaluate(text, scope)
