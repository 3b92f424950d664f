"""Find shell scripts that run no command any more, because all of their lines are comments or gone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changed_lines import is_shell_script, list_commands, split_content_lines
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.versions import Versions


def find_silent_scripts(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the shell scripts that have no commands any more, each with a change that names the old ones."""
    for file in changed_files:
        if file.old_path is None or file.new_path is None or file.is_submodule:
            continue
        if not is_shell_script(versions.old, file.old_path):
            continue
        old = list_commands(versions.old, file.old_path)
        if old is not None and not any(split_content_lines(versions.new.text(file.new_path))):
            text = phrase("runs no command any more; removed: {items}", items=old)
            reason = phrase("the programs that the script started no longer start")
            yield file.new_path, Change(text, Effect.BREAKING, reason, Location(file.new_path, 1, 1))
