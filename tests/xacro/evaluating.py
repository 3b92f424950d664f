"""The evaluation of single texts, for tests."""

from __future__ import annotations

from typing import Any

from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.limits import Limits, recursion_limit_for
from linkwright.xacro.session import Session


def evaluate(text: str, limits: Limits | None = None, **properties: Any) -> Any:
    """Return the value of a text with some properties in scope."""
    limits = limits or Limits()
    session = Session("main.xacro", {}, {}, limits)
    scope = Scope(session.globals, session, dict(properties))
    with recursion_limit_for(limits):
        return session.evaluate(text, scope)
