"""List the files of a repository whose lines are commands: shell scripts, Makefiles, CI, containers and units."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.review.changed_lines import UNIT_SUFFIX, is_shell_script
from linkwright.review.versions import Version

_NAMES = re.compile(
    r"(?:.*\.)?(?:gnu)?makefile(?:\..*)?|.*\.mk|\.?justfile|jenkinsfile|(?:.*\.)?(?:docker|container)file(?:\..*)?"
    r"|(?:.*[.-])?compose(?:[.-].*)?\.ya?ml|\.gitlab-ci\.ya?ml|\.travis\.ya?ml|azure-pipelines\.ya?ml",
    re.IGNORECASE,
)
_HIDDEN_FOLDERS = (".github", ".circleci", ".gitlab", ".ci")
_YAML_SUFFIXES = (".yml", ".yaml")
_SHELL_SUFFIXES = (".sh", ".bash", ".zsh")


def list_command_files(version: Version) -> Iterator[str]:
    """Yield the paths of the files with commands, relative to the root."""
    for path in version.paths(("",)):
        name = PurePosixPath(path).name
        is_known = name.endswith((*_SHELL_SUFFIXES, UNIT_SUFFIX)) or _NAMES.fullmatch(name) is not None
        if is_known or (not PurePosixPath(path).suffix and is_shell_script(version, path)):
            yield path
    for folder in _HIDDEN_FOLDERS:
        yield from version.paths((*_SHELL_SUFFIXES, *_YAML_SUFFIXES), folder)
