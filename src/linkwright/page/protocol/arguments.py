"""Asking the user for the arguments that a description needs and that have no value."""

from __future__ import annotations

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class ArgumentChoice(Record):
    """Values that are used together somewhere; `label` has those that differ from the other choices."""

    label: str
    values: dict[str, str]


class ArgumentForm(ServerMessage):
    """The arguments that a file needs, in order, and their initial values; without a file there is no form."""

    file: str
    names: list[str]
    values: dict[str, str]
    choices: list[ArgumentChoice]


NOTHING_ASKED = ArgumentForm(file="", names=[], values={}, choices=[])


class GiveArguments(PageMessage):
    """The user gives values to arguments of the form."""

    values: dict[str, str]
