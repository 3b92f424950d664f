"""The program that shells run when TAB is pressed.

It is called as ``python -m linkwright.cli.completion (--line LINE | WORD ...)``. The first word is the program, and the
last word, which may be empty, is the word at the cursor. The program prints the completions of this word, one per line.
"""

from __future__ import annotations

import sys

from linkwright.cli.completion.candidates import complete, split_line

if __name__ == "__main__":
    words = sys.argv[1:]
    for candidate in complete(split_line(words[1]) if words[:1] == ["--line"] else words):
        print(candidate)
