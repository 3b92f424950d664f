"""The environment variables of programs in terminals of the page."""

from __future__ import annotations

import sys
from collections.abc import Mapping

_VARIABLES_OF_OTHER_TERMINALS = (
    "COLUMNS",
    "LINES",
    "TERMCAP",
    "TERM_PROGRAM",
    "TERM_PROGRAM_VERSION",
    "WINDOWID",
    "VTE_VERSION",
)
"""The variables that describe the terminal in which this program was started."""

_UTF8_LOCALE = "UTF-8" if sys.platform == "darwin" else "C.UTF-8"
"""A locale with UTF-8 that is always available."""


def make_terminal_environment(base: Mapping[str, str]) -> dict[str, str]:
    """Return the environment variables for a program in a terminal of the page.

    The terminal understands the sequences of xterm, shows all colors, and uses UTF-8. Where no locale is set, as in
    containers, the variables select UTF-8, so that shells accept Chinese.

    Args:
        base: the environment variables to extend.
    """
    variables = {name: value for name, value in base.items() if name not in _VARIABLES_OF_OTHER_TERMINALS}
    variables.update(TERM="xterm-256color", COLORTERM="truecolor")
    locale = next((variables[name] for name in ("LC_ALL", "LC_CTYPE", "LANG") if variables.get(name)), "C")
    if locale in ("C", "POSIX") and "LC_ALL" not in variables:
        variables["LC_CTYPE"] = _UTF8_LOCALE
    return variables
