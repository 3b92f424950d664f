"""The settings that a rule declares."""

from __future__ import annotations

from linkwright.lean_dataclasses import dataclass

OptionValue = bool | int | float | str | list[str]
"""What an option of a rule may be, as TOML has it."""


@dataclass(frozen=True, slots=True)
class Option:
    """A setting of a rule, written in ``[options.RULE-NAME]`` of the configuration.

    Attributes:
        name: in kebab-case.
        default: the value in force when nobody sets it; another value must be of its type.
        meaning: one phrase for the documentation, with the unit.
    """

    name: str
    default: OptionValue
    meaning: str
