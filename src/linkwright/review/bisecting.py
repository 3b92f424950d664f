"""Search for the commit that changed a robot by bisecting the history, as git does."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.descriptions.comparison import Comparison, Difference
from linkwright.descriptions.pairs import Model, Pair
from linkwright.descriptions.revisions import CommitFiles
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    counted,
    did_you_mean,
    display_path,
    foreign,
    phrase,
)
from linkwright.files.git_repository import SHALLOW_HINT, GitRepository
from linkwright.review.frames import SharedFrames
from linkwright.review.robots.descriptions import format_difference
from linkwright.review.robots.parent_changes import ParentChanges
from linkwright.urdf import Robot

_SKIPPED_STATUS = 125
"""The exit status of a command that cannot judge a commit, as in ``git bisect run``."""


class UndecidedError(Exception):
    """Raised by a check that cannot judge a commit.

    For example, the description cannot be expanded.
    """


@dataclass(frozen=True)
class FoundCommit:
    """The first commit with the outcome of the newest commit.

    Attributes:
        commit: the hash of the commit.
        before: the hash of a previous commit with a different outcome: the first parent, or the last judged commit.
        title: the short hash, date, author and subject.
        undecided: the number of commits that could not be judged. One of them may be the first.
    """

    commit: str
    before: str
    title: str
    undecided: int


class History:
    """The commits of the repository of a file.

    Args:
        file: a file of the working tree.
        old: the oldest commit in git's notation; empty for the first commit of the file.
        new: the newest commit in git's notation.

    Attributes:
        old: the hash of the oldest commit.
        new: the hash of the newest commit.

    Raises:
        LinkwrightError: CLI341 to CLI344, git cannot find the repository, a commit, or the file in a commit; REV114,
            the oldest commit is not in the history of the newest one.
    """

    def __init__(self, file: Path, old: str, new: str) -> None:
        real_path = file.resolve()
        hint = phrase("`linkwright bisect` searches the commits of a git repository")
        self._repository = GitRepository(real_path.parent, display_path(file), hint, downloads_lfs=False)
        self.new = self._repository.require_commit(new)
        self._names = self._list_names(real_path.relative_to(self._repository.root).as_posix())
        self._require_file(self.new, new)
        self.old = self._repository.require_commit(old) if old else self._find_first_commit()
        self._require_ancestor(old, new)
        self._require_file(self.old, old or self.old)

    def name_in(self, commit: str) -> str | None:
        """Return the path of the file in a commit, relative to the root, or None if there is none."""
        return next((name for name in self._names if self._repository.contains(commit, name)), None)

    def files(self, commit: str) -> CommitFiles:
        """Return the files of a commit. The caller closes them."""
        return CommitFiles(self._repository, commit, commit[:9], must_be_complete=False)

    def search(self, judge: Callable[[str], bool], on_step: Callable[[int], object]) -> FoundCommit | None:
        """Return the first commit with the outcome of the newest commit.

        The result is None if the oldest commit also has that outcome.

        Args:
            judge: a function that returns the outcome of a commit, and raises `UndecidedError` if it cannot.
            on_step: called before each step with the number of remaining candidates.

        Raises:
            LinkwrightError: REV113, the oldest or the newest commit cannot be judged.
        """
        outcome = self._judge_end(judge, self.new)
        if self._judge_end(judge, self.old) == outcome:
            return None
        first, earlier = self.new, [self.old]
        undecided: set[str] = set()
        while True:
            candidates = self._list_candidates(first, earlier)
            on_step(len(candidates) + 1)
            commit = next((candidate for candidate in candidates if candidate not in undecided), None)
            if commit is None:
                parent = self._repository.resolve(f"{first}^")
                before = parent if parent in earlier else earlier[-1]
                return FoundCommit(first, before, self._read_title(first), len(undecided & set(candidates)))
            try:
                has_outcome = judge(commit) == outcome
            except UndecidedError:
                undecided.add(commit)
                continue
            if has_outcome:
                first = commit
            else:
                earlier.append(commit)

    def _require_file(self, commit: str, name: str) -> None:
        if self.name_in(commit) is None:
            message = phrase("commit '{name}' has no file '{inside}'", name=name, inside=self._names[0])
            raise LinkwrightError(Diagnostic("CLI344", message))

    def _require_ancestor(self, old: str, new: str) -> None:
        """Raise an error if the oldest commit is not in the history of the newest commit."""
        if self._repository.is_ancestor(self.old, self.new):
            return
        message = phrase("commit '{old}' is not in the history of '{new}'", old=old, new=new)
        common = self._repository.merge_base(self.old, self.new)
        hint = phrase("pass commits of one history, such as `--old {old}~5 --new {old}`", old=old)
        if common == self.new:
            hint = phrase("'{new}' is the older one: `--old {new} --new {old}`", old=old, new=new)
        elif common is not None:
            hint = phrase(
                "begin with the last commit that both have in common: `--old {common} --new {new}`",
                common=common[:9],
                new=new,
            )
        elif self._repository.is_shallow:
            hint = SHALLOW_HINT
        raise LinkwrightError(Diagnostic("REV114", message, hint=hint))

    def _judge_end(self, judge: Callable[[str], bool], commit: str) -> bool:
        """Return the outcome of the oldest or newest commit.

        Raises:
            LinkwrightError: REV113, the commit cannot be judged.
        """
        try:
            return judge(commit)
        except UndecidedError as error:
            raise self._make_undecided_error(commit, error) from error.__cause__

    def _make_undecided_error(self, commit: str, error: UndecidedError) -> LinkwrightError:
        cause = error.__cause__
        notes = (
            tuple(Note(finding.message) for finding in cause.diagnostics) if isinstance(cause, LinkwrightError) else ()
        )
        title = self._read_title(commit)
        message = phrase("the oldest commit cannot be judged: {title}", title=title)
        hint = phrase("name a later commit that can be judged: `--old COMMIT`")
        if commit == self.new:
            message = phrase("the newest commit cannot be judged: {title}", title=title)
            hint = phrase("name an earlier commit that can be judged: `--new COMMIT`")
        return LinkwrightError(Diagnostic("REV113", message, notes=notes, hint=hint))

    def _list_candidates(self, first: str, earlier: Sequence[str]) -> list[str]:
        """Return the candidates besides `first`, from the middle of the history outward."""
        excluded = [f"^{commit}" for commit in earlier]
        lines = self._repository.run("rev-list", "--bisect-all", first, *excluded).stdout.splitlines()
        return [commit for commit in (line.split(" ")[0] for line in lines) if commit != first]

    def _read_title(self, commit: str) -> str:
        return self._repository.run("log", "--max-count=1", "--format=%h %as %an: %s", commit).stdout.strip()

    def _list_names(self, name: str) -> list[str]:
        """Return the names of the file in the history, the newest first."""
        arguments = ("log", "--follow", "--name-only", "-z", "--format=", "--", name)
        names = self._repository.run(*arguments).stdout.split("\0")
        return list(dict.fromkeys([name, *filter(None, names)]))

    def _find_first_commit(self) -> str:
        """Return the commit that added the file to the history of the newest commit."""
        name = self.name_in(self.new) or self._names[0]
        commits = self._repository.run("log", "--follow", "--format=%H", self.new, "--", name).stdout.split()
        return commits[-1] if commits else self.new


# --- checks ----------------------------------------------------------------------------------------------------------


class PartCheck:
    """A check whether a link or joint is the same as in the newest commit.

    Args:
        history: the commits to search.
        values: the values of the description's arguments.
        name: the name of the link or joint.

    Raises:
        LinkwrightError: the newest commit's description cannot be read; REV111, it has no such link or joint.
    """

    def __init__(self, history: History, values: Mapping[str, str], name: str) -> None:
        self._history = history
        self._values = values
        self._name = name
        self._new_files = history.files(history.new)
        try:
            self._new = self._read_model(self._new_files, history.new)
            self._robot = self._new.read_robot()
            _require_link_or_joint(self._robot, name)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Remove the files of the newest commit."""
        self._new_files.close()

    def __call__(self, commit: str) -> bool:
        """Return whether the link or joint is the same in a commit as in the newest one."""
        return not self.differences(commit)

    def differences(self, commit: str) -> list[Difference | Phrase]:
        """Return the differences in the link or joint between a commit and the newest one.

        Raises:
            UndecidedError: the description of the commit cannot be read.
        """
        files = self._history.files(commit)
        try:
            old = self._read_model(files, commit)
            robot = old.read_robot()
            comparison = Pair(old, self._new).compare(robot, self._robot)
            return list(self._select_relevant(comparison, robot))
        except LinkwrightError as error:
            raise UndecidedError from error
        finally:
            files.close()

    def _select_relevant(self, comparison: Comparison, old: Robot) -> Iterator[Difference | Phrase]:
        frames = SharedFrames(old, self._robot, comparison.links)
        parents = ParentChanges(comparison, self._robot, frames)
        for difference in comparison.differences:
            is_renamed = difference.kind == "renamed" and difference.old == self._name
            if difference.subject in ("link", "joint") and (difference.name == self._name or is_renamed):
                yield parents.sentence(difference) or difference
        old_name = next((before for before, after in comparison.links.items() if after == self._name), None)
        if old_name is not None:
            motion = frames.motion(old_name)
            if motion is not None and motion[0]:
                yield phrase("link '{name}': moved by {distance:.4g} m", name=self._name, distance=motion[0])
            elif motion is not None:
                yield phrase("link '{name}': rotated by {angle:.3g}°", name=self._name, angle=motion[1])

    def _read_model(self, files: CommitFiles, commit: str) -> Model:
        name = self._history.name_in(commit)
        if name is None:
            raise UndecidedError
        path = files.root / name
        return Model(path, self._values, files.finder(path.parent), files)


def _require_link_or_joint(robot: Robot, name: str) -> None:
    names = [*robot.links, *robot.joints]
    if name not in names:
        message = phrase("the robot has no link or joint '{name}'", name=name)
        hint = did_you_mean(name, names) or phrase("a command has more than one word: `-- check_urdf FILE`")
        raise LinkwrightError(Diagnostic("REV111", message, hint=hint))


@dataclass(frozen=True)
class CommandCheck:
    """A check by a command that runs in the folder with the files of a commit.

    Attributes:
        history: the commits to search.
        words: the command; the word ``FILE`` is replaced by the path of the description.
    """

    history: History
    words: Sequence[str]

    def __call__(self, commit: str) -> bool:
        """Return whether the command succeeds in a commit.

        Raises:
            UndecidedError: the command exits with status 125, or the commit does not contain the file.
            LinkwrightError: REV112, the command cannot be started.
        """
        name = self.history.name_in(commit)
        if name is None:
            raise UndecidedError
        files = self.history.files(commit)
        try:
            command = [str(files.root / name) if word == "FILE" else word for word in self.words]
            result = subprocess.run(command, cwd=files.root, check=False, stdout=subprocess.DEVNULL)  # noqa: S603 - the user's command
        except OSError as error:
            reason = foreign(error.strerror or str(error))
            message = phrase("cannot start '{command}': {reason}", command=self.words[0], reason=reason)
            raise LinkwrightError(Diagnostic("REV112", message)) from None
        finally:
            files.close()
        if result.returncode == _SKIPPED_STATUS:
            raise UndecidedError
        return result.returncode == 0


def format_part_difference(difference: Difference | Phrase) -> Phrase:
    """Return a difference in one line."""
    return difference if isinstance(difference, Phrase) else format_difference(difference)


def format_undecided_count(count: int) -> Phrase:
    """Return the line about commits that could not be judged."""
    return counted(
        "one commit before it cannot be judged and may be the first",
        "{count} commits before it cannot be judged, and one of them may be the first",
        count,
    )
