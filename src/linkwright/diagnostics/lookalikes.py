"""Characters that look like ASCII characters of code.

They are full-width punctuation and digits, curved quotes, dashes and signs.
"""

from __future__ import annotations

from linkwright.diagnostics.phrase import Phrase, phrase

_ASCII_BY_LOOKALIKE = {
    "\u201c": '"',
    "\u201d": '"',
    "\u201e": '"',
    "\u2018": "'",
    "\u2019": "'",
    "\u2010": "-",
    "\u2011": "-",
    "\u2012": "-",
    "\u2013": "-",
    "\u2014": "-",
    "\u2212": "-",
    "\u00d7": "*",
    "\u00f7": "/",
    "\u3001": ",",
    "\u3002": ".",
    "\u3010": "[",
    "\u3011": "]",
    "\u300a": "<",
    "\u300b": ">",
    "\u3000": " ",
    "\u00a0": " ",
}
_FIRST_FULL_WIDTH, _LAST_FULL_WIDTH, _FULL_WIDTH_SHIFT = 0xFF01, 0xFF5E, 0xFEE0


def to_ascii_character(character: str) -> str | None:
    """Return the ASCII character that a character looks like, or None."""
    if character and _FIRST_FULL_WIDTH <= ord(character) <= _LAST_FULL_WIDTH:
        return chr(ord(character) - _FULL_WIDTH_SHIFT)
    return _ASCII_BY_LOOKALIKE.get(character)


def to_ascii_text(text: str) -> str:
    """Return a text with ASCII characters in place of those that look like them."""
    return "".join(to_ascii_character(character) or character for character in text)


def lookalike_hint(text: str) -> Phrase | None:
    """Return a hint about the first character of a text that looks like ASCII, or None."""
    for character in text:
        plain = to_ascii_character(character)
        if plain == " ":
            return phrase("write a plain space in place of U+{code:04X}", code=ord(character))
        if plain is not None:
            return phrase("replace '{character}' with the ASCII character '{plain}'", plain=plain, character=character)
    return None
