"""Writes values of YAML so that every reader understands them as intended."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

_PLAIN = re.compile(r"[A-Za-z_][\w./@+-]*(:=?[\w./@+-]+)*")
_KEYWORDS = frozenset({"y", "n", "yes", "no", "on", "off", "true", "false", "null"})


def quote_yaml(text: str) -> str:
    """Return a text as a YAML scalar, with quotes if a reader would take it for something else."""
    return text if _PLAIN.fullmatch(text) and text.lower() not in _KEYWORDS else json.dumps(text, ensure_ascii=False)


def yaml_number(value: float) -> str:
    """Return a number as YAML with a decimal point, because parameters of ROS 2 have types."""
    text = f"{value:.10f}".rstrip("0")
    return f"{text}0" if text.endswith(".") else text


def yaml_list(texts: Iterable[str], indent: int) -> str:
    """Return a block sequence of texts, without a line end after the last one."""
    return "\n".join(f"{' ' * indent}- {quote_yaml(text)}" for text in texts)
