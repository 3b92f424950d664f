"""Which docks of RViz's window are shown, in the state of it that Qt writes.

``QMainWindow::saveState`` gives for each dock the byte 0xfb, its name (the number of its bytes in four bytes, then
UTF-16, both big endian) and a byte of flags: 1 shown, 2 floating. Of several of one name the first is the dock; the
others are places that it had once. RViz keeps all this as hexadecimal digits. Everything else in it stays as it is.
"""

from __future__ import annotations

_DOCK = b"\xfb"
_SHOWN = 1


def is_shown(state: str, name: str) -> bool | None:
    """Whether a dock is shown; None where the state does not know it, or is none that Qt wrote.

    Args:
        state: the hexadecimal digits.
        name: of the dock, which is that of its panel.
    """
    content = _bytes(state)
    at = _flags(content, name)
    return None if at is None else bool(content[at] & _SHOWN)


def with_shown(state: str, name: str, shown: bool) -> str:
    """The state with a dock shown or hidden; the same one where that is so already or the dock is not known."""
    content = _bytes(state)
    at = _flags(content, name)
    if at is None or bool(content[at] & _SHOWN) is shown:
        return state
    # Of two digits a byte: the others stay in the case that they have.
    return f"{state[: 2 * at]}{content[at] ^ _SHOWN:02x}{state[2 * at + 2 :]}"


def _bytes(state: str) -> bytes:
    """What the digits stand for; nothing where they are none."""
    try:
        content = bytes.fromhex(state)
    except ValueError:
        return b""
    return content if 2 * len(content) == len(state) else b""  # `fromhex` passes over white space


def _flags(content: bytes, name: str) -> int | None:
    """Where the flags of a dock are."""
    text = name.encode("utf-16-be", "surrogatepass")
    mark = _DOCK + len(text).to_bytes(4, "big") + text
    at = content.find(mark) + len(mark)
    return at if len(mark) <= at < len(content) else None
