"""Command-line flags in the form of gflags: ``-name value``, ``-name=value`` and ``-noname``, with one or two hyphens.

Source: the documentation of gflags, "Setting Flags on the Command Line".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase

FlagValue = bool | float | str
_TRUE_WORDS, _FALSE_WORDS = ("true", "t", "yes", "y", "1"), ("false", "f", "no", "n", "0")


def parse_flags(arguments: Sequence[str], defaults: Mapping[str, FlagValue]) -> dict[str, FlagValue]:
    """Return the values of all flags.

    Args:
        arguments: the arguments without ROS arguments; those that are not flags are ignored.
        defaults: the default of each flag, whose type is the type of the flag.

    Raises:
        LinkwrightError: NODE432, a flag does not exist, or its value is missing or invalid.
    """
    values = dict(defaults)
    remaining = list(arguments)
    while remaining:
        argument = remaining.pop(0)
        if argument == "--":
            break
        if not argument.startswith("-") or argument == "-":
            continue
        name, has_value, text = argument.lstrip("-").partition("=")
        if name not in defaults and name.startswith("no") and isinstance(defaults.get(name[2:]), bool):
            values[name[2:]] = False
            continue
        if name not in defaults:
            message = phrase("unknown flag '{flag}'", flag=argument)
            raise LinkwrightError(Diagnostic("NODE432", message, hint=did_you_mean(name, list(defaults))))
        if isinstance(defaults[name], bool):
            values[name] = _read_flag(name, text) if has_value else True
            continue
        if not has_value:
            if not remaining:
                raise LinkwrightError(Diagnostic("NODE432", phrase("the value of '{flag}' is missing", flag=argument)))
            text = remaining.pop(0)
        values[name] = text if isinstance(defaults[name], str) else _read_number(name, text)
    return values


def _read_flag(name: str, text: str) -> bool:
    if text.lower() not in (*_TRUE_WORDS, *_FALSE_WORDS):
        raise _make_error(name, text)
    return text.lower() in _TRUE_WORDS


def _read_number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise _make_error(name, text) from None


def _make_error(name: str, text: str) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic("NODE432", phrase("'{text}' is not a valid value for '{name}'", text=text, name=name))
    )
