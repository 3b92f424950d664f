"""Asks pages for the arguments that a description needs and nobody gave."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.arguments import NOTHING_ASKED, ArgumentForm, GiveArguments
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.web.audience import Page

Give = Callable[[dict[str, str]], object]
"""Takes the values that a user gives."""


class ArgumentsFeature(PageFeature):
    """Shows every page the same form, and passes on the first answer."""

    RECEIVES: ClassVar[tuple[type, ...]] = (GiveArguments,)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._form = NOTHING_ASKED
        self._give: Give | None = None

    def opening(self) -> list[ServerMessage]:
        """The form."""
        return [self._form]

    def ask(self, form: ArgumentForm, give: Give | None) -> None:
        """Show a form; `give` is called with the values of the page that answers first."""
        self._form, self._give = form, give
        self.context.pages.publish(form)

    def receive(self, page: Page, message: GiveArguments) -> None:
        """Take the values of the arguments that were asked for."""
        give, names = self._give, set(self._form.names)
        if give is not None:
            self.ask(NOTHING_ASKED, None)
            give({name: value for name, value in message.values.items() if name in names})
