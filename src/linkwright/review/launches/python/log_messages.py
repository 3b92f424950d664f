"""Read the actions of Python launch files that only write a text to the log."""

from __future__ import annotations

import ast

from linkwright.diagnostics import Span
from linkwright.review.launches.outlines import CONDITION, LOG_MESSAGE, Entry, Scope
from linkwright.review.launches.python.expression_texts import ExpressionTexts

LOG_CLASS = "LogInfo"


def read_log_message(call: ast.Call, scope: Scope, texts: ExpressionTexts, span: Span) -> Entry:
    """Return the action of a call of ``LogInfo``.

    Args:
        call: the call.
        scope: the settings that the groups around it give to the action.
        texts: the texts of expressions where it is written.
        span: the location of the call.
    """
    keywords = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
    settings = {"text": texts.format_joined(keywords["msg"])} if "msg" in keywords else {}
    condition = texts.format_condition(keywords.get(CONDITION))
    if condition:
        settings[CONDITION] = condition
    return Entry(LOG_MESSAGE, LOG_CLASS, scope.add_to_settings(LOG_MESSAGE, settings), span)
