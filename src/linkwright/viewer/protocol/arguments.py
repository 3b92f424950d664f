"""Asking the user for the arguments that a description needs and nobody gave."""

from __future__ import annotations

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class ArgumentChoice(Record):
    """Values that are given together somewhere; `label` has what sets them apart from the other choices."""

    label: str
    values: dict[str, str]


class ArgumentForm(ServerMessage):
    """The arguments that a file needs, in order, and the values to begin with; without a file nothing is asked."""

    file: str
    names: list[str]
    values: dict[str, str]
    choices: list[ArgumentChoice]


NOTHING_ASKED = ArgumentForm(file="", names=[], values={}, choices=[])


class GiveArguments(PageMessage):
    """The user gives values to arguments of the form."""

    values: dict[str, str]
