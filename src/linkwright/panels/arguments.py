"""Asks pages for the arguments that a description needs and that have no value."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from linkwright.page.audience import Page
from linkwright.page.protocol.description import NOTHING_ASKED, ArgumentForm, GiveArguments
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature

Give = Callable[[dict[str, str]], object]
"""Receives the values that a user gives."""


class ArgumentsFeature(PageFeature):
    """Shows every page the same form, and forwards the first answer."""

    RECEIVES: ClassVar[tuple[type, ...]] = (GiveArguments,)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._form = NOTHING_ASKED
        self._give: Give | None = None

    def opening(self) -> list[ServerMessage]:
        """The form."""
        return [self._form]

    def ask(self, form: ArgumentForm, give: Give | None) -> None:
        """Show a form; `give` is called with the values of the first answer."""
        self._form, self._give = form, give
        self.context.pages.publish(form)

    def receive(self, page: Page, message: GiveArguments) -> None:
        """Handle the values for the requested arguments."""
        give, names = self._give, set(self._form.names)
        if give is not None:
            self.ask(NOTHING_ASKED, None)
            give({name: value for name, value in message.values.items() if name in names})
