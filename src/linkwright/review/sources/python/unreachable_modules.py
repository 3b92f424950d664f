"""Find Python modules that no program is made of, so that no other program uses their topics and options."""

from __future__ import annotations

import os
import re
from pathlib import PurePosixPath

from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.caching import cached_in_review
from linkwright.review.files.build.setup_files import SETUP_FILE
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

_USER_SUFFIXES = (
    *(PYTHON_SUFFIX, ".cpp", ".hpp", ".launch", ".xml", ".yaml", ".yml", ".sh", ".bash", ".service", ".desktop"),
    *(".cfg", ".toml", ".txt", ".md", ".rst", ".json", "Makefile", "Dockerfile"),
)
"""The ends of the names of files that may start or import a module, or tell users to do so."""
_DYNAMIC_IMPORT = re.compile(r"\b(?:importlib|__import__|pkgutil)\b")
_BUILD_TYPE = "ament_python"
_SPECIAL_NAMES = frozenset({"__init__", "__main__", "setup", "conftest"})


@cached_in_review(maxsize=256)
def is_unreachable(version: Version, package: str | None, path: str) -> bool:
    """Return whether nothing starts or imports a Python module, as far as the repository tells.

    The module belongs to a package of ament_python, whose ``setup.py`` names all programs that ``ros2 run`` finds. It
    is not executable, and no other file contains its name.

    Args:
        version: the version of the repository that has the module.
        package: the folder of its package; None for a file outside of packages.
        path: the path of the module.
    """
    stem = PurePosixPath(path).stem
    if package is None or not path.endswith(PYTHON_SUFFIX) or stem in _SPECIAL_NAMES:
        return False
    if is_launch_file_name(PurePosixPath(path).name) or os.access(version.file(path), os.X_OK):
        return False
    manifest = version.file(package) / MANIFEST
    facts = read_package_facts(version, package)
    if not manifest.is_file() or Manifest(read_document(str(manifest))).build_type != _BUILD_TYPE or facts is None:
        return False
    own = PurePosixPath(path).relative_to(package).as_posix()
    setup = version.text((PurePosixPath(package) / SETUP_FILE).as_posix())
    if not facts.is_complete or own in facts.files.values() or _DYNAMIC_IMPORT.search(setup):
        return False
    word = re.compile(rf"(?<!\w){re.escape(stem)}(?!\w)")
    texts = (version.text(other) for other in version.paths(_USER_SUFFIXES) if other != path)
    beside = (version.text(other) for other in version.paths((PYTHON_SUFFIX,), package) if other != path)
    return not any(word.search(text) for text in texts) and not any(map(_DYNAMIC_IMPORT.search, beside))
