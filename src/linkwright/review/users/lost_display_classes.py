"""Find RViz configurations that use classes which no plugin description declares any more."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.plugin_files import list_lost_classes
from linkwright.review.versions import Versions

_RVIZ_SUFFIX = ".rviz"
_CLASS = re.compile(r"^[ \t-]*Class:[ \t]*[\"']?(?P<name>[\w/:]+)", re.MULTILINE)


def find_lost_display_classes(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the RViz configurations with a display, tool or panel of a lost class, each with a change for the class."""
    lost = list_lost_classes(versions, changed_files)
    for path in versions.new.paths((_RVIZ_SUFFIX,)) if lost else ():
        text = versions.new.text(path)
        places = {match["name"]: match.start("name") for match in reversed(list(_CLASS.finditer(text)))}
        for name in sorted(lost & places.keys()):
            message = phrase("uses the class '{name}', which no plugin description declares any more", name=name)
            reason = phrase("RViz does not load it")
            line = text[: places[name]].count("\n") + 1
            yield path, Change(message, Effect.BREAKING, reason, Location(path, line, 1))
