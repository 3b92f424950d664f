"""One line of a terminal that says how far a command has come."""

from __future__ import annotations

import sys

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import localized


class ProgressLine:
    """Written over again and again; where standard error is no terminal, nothing is written."""

    def __init__(self) -> None:
        self.shown = sys.stderr.isatty()
        self._written = False

    def show(self, text: Phrase) -> None:
        """Write the line anew."""
        if self.shown:
            sys.stderr.write(f"\r{localized(text)}\x1b[K")
            sys.stderr.flush()
            self._written = True

    def end(self) -> None:
        """Take the line away."""
        if self._written:
            sys.stderr.write("\r\x1b[K")
            self._written = False
