"""The options that a rule declares."""

from __future__ import annotations

from linkwright.loading.lean_dataclasses import dataclass

OptionValue = bool | int | float | str | list[str]
"""The TOML types that an option of a rule may have."""


@dataclass(frozen=True, slots=True)
class Option:
    """An option of a rule, set in ``[options.RULE-NAME]`` of the configuration.

    Attributes:
        name: the name in kebab-case.
        default: the default, which also determines the type of other values.
        meaning: one phrase for the documentation, with the unit.
    """

    name: str
    default: OptionValue
    meaning: str
