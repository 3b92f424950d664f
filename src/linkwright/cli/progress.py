"""A progress line in the terminal."""

from __future__ import annotations

import sys

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.translation import localized


class ProgressLine:
    """A line that is overwritten on each update.

    Nothing is written if standard error is not a terminal.
    """

    def __init__(self) -> None:
        self.is_shown = sys.stderr.isatty()
        self._has_text = False

    def show(self, text: Phrase) -> None:
        """Replace the text of the line."""
        if self.is_shown:
            sys.stderr.write(f"\r{localized(text)}\x1b[K")
            sys.stderr.flush()
            self._has_text = True

    def end(self) -> None:
        """Erase the line."""
        if self._has_text:
            sys.stderr.write("\r\x1b[K")
            self._has_text = False
