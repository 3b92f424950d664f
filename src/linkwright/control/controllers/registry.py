"""Which controllers there are: the entry points ``linkwright.controllers``, by their type names.

``diff_drive_controller/DiffDriveController`` names a subclass of `Controller`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, foreign, phrase
from linkwright.extensions import extensions

if TYPE_CHECKING:
    from linkwright.control.controllers.controller import Controller

GROUP = "linkwright.controllers"


def controller_types() -> list[str]:
    """The type names of all controllers."""
    return list(extensions(GROUP))


def controller_class(type_name: str) -> type[Controller[Any]]:
    """The class of a controller.

    Raises:
        LinkwrightError: CTL103 there is none of that type; CTL104 the package that brings it cannot be imported.
    """
    entry = extensions(GROUP).get(type_name)
    if entry is None:
        message = phrase("there is no controller of type '{name}'", name=type_name)
        raise LinkwrightError(Diagnostic("CTL103", message, hint=did_you_mean(type_name, controller_types())))
    try:
        found: type[Controller[Any]] = entry.load()
    except Exception as error:
        message = phrase("the controller '{name}' cannot be imported", name=type_name)
        hint = phrase("'{place}' brings it: {problem}", place=entry.distribution, problem=foreign(error))
        raise LinkwrightError(Diagnostic("CTL104", message, hint=hint)) from error
    return found
