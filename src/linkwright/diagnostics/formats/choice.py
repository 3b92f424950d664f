"""The output formats, by the values of ``--format``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module

from linkwright.diagnostics.diagnostic import Diagnostic
from linkwright.diagnostics.translation import translated
from linkwright.loading.lean_typing import cast

FORMATS = ("text", "concise", "json", "sarif", "github")
"""``text`` for people, ``concise`` with one line each, ``json`` and ``sarif`` for programs, ``github`` for Actions."""

_Formatter = Callable[[Iterable[Diagnostic]], str]


def format_diagnostics(diagnostics: Iterable[Diagnostic], format_name: str) -> str:
    """Return diagnostics as text that ends with a newline.

    The text is empty if there are no diagnostics and the format has one line per diagnostic. Messages are in English
    unless another language was requested by name (`--lang`).

    Args:
        diagnostics: the diagnostics, in the order in which they are shown.
        format_name: an item of `FORMATS` except ``text``, which `linkwright.diagnostics.print_diagnostics` writes.
    """
    if format_name not in FORMATS or format_name == "text":
        raise ValueError(f"no format '{format_name}'")
    module = import_module(f"linkwright.diagnostics.formats.{format_name}")
    return cast(_Formatter, module.to_text)(translated(diagnostics, for_programs=True))
