"""Compare semantic descriptions in xacro, expanded with the defaults of their arguments."""

from __future__ import annotations

from pathlib import Path

from linkwright.descriptions import Description, examine
from linkwright.diagnostics import LinkwrightError
from linkwright.lint.targets import find_files_and_packages
from linkwright.review.file_pair import FilePair
from linkwright.review.files.arms.semantics import compare_roots
from linkwright.review.parts.expanded import find_expanded_elements
from linkwright.review.robots.cases import find_fault
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

SUFFIX = ".srdf.xacro"
_DEFINITIONS = frozenset({"xacro:macro", "xacro:property", "xacro:arg", "xacro:include"})


def find_semantic_files(version: Version) -> set[str]:
    """Return the paths of the semantic xacro descriptions.

    Files that only contain definitions for other files are left out.
    """
    files, _ = find_files_and_packages(version.root, (SUFFIX,))
    paths = (version.relative(file) for file in files if _has_content(file))
    return {path for path in paths if path is not None}


def compare_expanded_semantics(pair: FilePair) -> None:
    """Compare two versions of a semantic description in xacro.

    If neither version can be expanded, for example because of a missing package, nothing is reported: the files are
    then compared as written.
    """
    old, new = (
        _try_expand(version, path)
        for version, path in ((pair.versions.old, pair.old_path), (pair.versions.new, pair.new_path))
    )
    if isinstance(old, Description) and isinstance(new, Description):
        pair.expanded.update(find_expanded_elements(pair.versions, old, new))
        compare_roots(pair, old.document.root, new.document.root)
    elif isinstance(old, Description) or isinstance(new, Description):
        pair.add_faults(find_fault(old, pair.versions.old), find_fault(new, pair.versions.new))


def _has_content(file: Path) -> bool:
    try:
        root = read_document(str(file)).root
    except (LinkwrightError, OSError):
        return False
    return any(element.tag not in _DEFINITIONS for element in root.elements())


def _try_expand(version: Version, path: str) -> Description | LinkwrightError:
    file = version.file(path)
    try:
        return examine(file, packages=version.finder(file.parent))
    except LinkwrightError as error:
        return error
