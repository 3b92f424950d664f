"""The settings of detectors, from parameters or a command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase


def setting_error(name: str, value: object, hint: Phrase | None = None) -> LinkwrightError:
    """Return the error for an invalid value of a detector's setting (VISION109)."""
    message = phrase("the setting '{name}' of the detector cannot be '{value}'", name=name, value=value)
    return LinkwrightError(Diagnostic("VISION109", message, hint=hint))


def read_number(settings: Mapping[str, object], name: str, default: float, minimum: float, maximum: float) -> float:
    """Return a setting as a number within limits.

    Raises:
        LinkwrightError: VISION109, the setting is not such a number.
    """
    value = settings.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not minimum <= value <= maximum:
        raise setting_error(
            name, value, phrase("give a number from {minimum} to {maximum}", minimum=minimum, maximum=maximum)
        )
    return float(value)


def read_choice(settings: Mapping[str, object], name: str, default: str, choices: Sequence[str]) -> str:
    """Return a setting that is one of several words.

    Raises:
        LinkwrightError: VISION109, the setting is not one of these words.
    """
    value = str(settings.get(name, default))
    if value not in choices:
        hint = did_you_mean(value, choices) or phrase("choose from {names}", names=", ".join(choices))
        raise setting_error(name, value, hint)
    return value


def parse_hsv_range(name: str, value: object) -> tuple[int, ...]:
    """Parse a range of colors in OpenCV's units.

    The six numbers are the minimum hue, saturation and value, and then the maximum of each.

    Raises:
        LinkwrightError: VISION109, the value is not a list of six such numbers.
    """
    numbers = list(value) if isinstance(value, Sequence) and not isinstance(value, str) else []
    maxima = (179, 255, 255) * 2
    if len(numbers) != 6 or not all(
        isinstance(component, int | float) and 0 <= component <= maximum
        for component, maximum in zip(numbers, maxima, strict=True)
    ):
        hint = phrase(
            "give six numbers: the minimum hue (0 to 179), saturation and value (0 to 255), then the maximum of each"
        )
        raise setting_error(name, value, hint)
    return tuple(int(number) for number in numbers)
