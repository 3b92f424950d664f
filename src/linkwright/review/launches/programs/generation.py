"""Tell whether the build of a package may make files that its folder does not contain."""

from __future__ import annotations

import re

_COMMENT = re.compile(r"#[^\n]*")
_GENERATION = re.compile(
    r"\b(?:RENAME|configure_file|add_custom_command|add_custom_target|execute_process|ExternalProject_Add"
    r"|FetchContent_\w+|file\s*\(\s*(?:GENERATE|WRITE|DOWNLOAD|COPY|COPY_FILE|CREATE_LINK))\b",
    re.IGNORECASE,
)
"""A command of a build file that can make a script with another name."""
_QUOTES = r"[\\\"']*"
_GROUP = r"\([^()]*(?:\([^()]*\)[^()]*)*\)"
_QUERY = (
    rf"(?:sudo\s+)?{_QUOTES}(?:/[\w/]*/)?(?:chmod|chown|setcap|ldconfig|date|uname|nproc|lsb_release|pkg-config|rosversion)\b"
    rf"|{_QUOTES}(?:git|\$\{{GIT_EXECUTABLE\}}){_QUOTES}\s+(?:-C\s+\S+\s+)?(?:rev-parse|describe|log|status|tag)\b"
    rf"|{_QUOTES}\$\{{CMAKE_COMMAND\}}{_QUOTES}\s+-E\s+(?:echo|make_directory|rm|remove|remove_directory)\b"
    rf"|\S*python\S*\s+-m\s+compileall\b"
    rf"|\S*python\S*\s+-c\s+[\\\"']+(?:import\s+[\w., ]+;\s*)*print\s*{_GROUP}[\\\"']"
)
"""The start of a command that makes no file which others can name: it tells a fact, or changes files that exist."""
_QUERYING_PROCESS = re.compile(
    rf"\bexecute_process\s*\(\s*COMMAND\s+(?:{_QUERY})"
    rf"(?:(?!\b(?:COMMAND|OUTPUT_FILE|ERROR_FILE|execute_process)\b)[^()]|{_GROUP})*\)",
    re.IGNORECASE,
)
"""A command of CMake that only runs such a command, also in ``install(CODE ...)``."""


def may_make_files(build_text: str) -> bool:
    """Return whether the commands of build files can make a file.

    Args:
        build_text: the text of the build files. The comments of catkin's template tell how to rename a program.
    """
    return _GENERATION.search(_QUERYING_PROCESS.sub("", _COMMENT.sub("", build_text))) is not None
