"""Hide passwords and tokens in a review, because reports are published as comments of pull requests."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.changes import Change, Review
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.texts.folders import change_texts, review_with_texts
from linkwright.review.versions import Version, Versions

_HIDDEN = "***"
_WORD = r"(?:pass(?:word|wd|phrase|code)|pwd|secret|token|api_?key|access_?key|secret_?key|private_?key|credentials?)"
_NAME = rf"(?<![A-Za-z])(?:[\w.-]*_)?{_WORD}(?![\w])"
_QUOTED = r"(?P<{0}>['\"])(?P<{0}_value>(?:(?!(?P={0}))[^\n\\])+)(?P={0})"
_LITERALS = (
    # Python, C++, JSON and YAML: NAME: "VALUE", NAME = "VALUE", ("NAME", "VALUE"), ("NAME", default_value="VALUE")
    re.compile(
        rf"(?:{_NAME})(?:['\"]?\]?\s*(?::|=(?!=))|['\"]\s*,(?:\s*[\w.&:]+\s*[,=])?)\s*[ru]?{_QUOTED.format('quote')}",
        re.IGNORECASE,
    ),
    # XML: <arg name="NAME" default="VALUE"/>
    re.compile(
        rf"\bname\s*=\s*['\"](?:{_NAME})['\"][^<>]*?\b(?:value|default)\s*=\s*{_QUOTED.format('quote')}", re.IGNORECASE
    ),
    # hardware of ros2_control: <param name="NAME">VALUE</param>
    re.compile(rf"\bname\s*=\s*['\"](?:{_NAME})['\"]\s*>(?P<value>[^<>]+)</", re.IGNORECASE),
    # an address: rtsp://user:VALUE@host
    re.compile(r"\b\w+://[^\s:/@'\"]+:(?P<value>[^\s@/'\"]+)@"),
)
_PLAIN = re.compile(
    rf"(?:{_NAME})\s*[:=][ \t]*(?P<value>[^\s'\"#{{\[,;&|>]\S*)[ \t]*(?:$|#|\s)", re.IGNORECASE | re.MULTILINE
)
"""A value without quotation marks, in YAML and in commands."""
_PLAIN_SUFFIXES = (".yaml", ".yml", ".sh", ".bash", ".env", ".cfg", ".ini", ".conf", ".service", "")
_NO_SECRETS = re.compile(
    r"[$<{%*}\-].*|.*[$][({].*|.*\s.*|.{1,2}"
    r"|(?:true|false|none|null|nil|yes|no|read|write|str|string|bool|int|double|float|std::string|x+)",
    re.IGNORECASE,
)
"""Values that are not secrets: substitutions, placeholders, types and switches."""
_CLASSES = tuple(map(re.compile, ("[a-z]", "[A-Z]", "[0-9]", r"[^A-Za-z0-9\s_./:-]")))
_MIN_CLASSES = 3
_SETTINGS = (".yaml", ".yml")


def hide_secrets(versions: Versions, result: Review) -> Review:
    """Return a review whose texts have ``***`` in place of the passwords and tokens that the files contain.

    A secret that could be an ordinary word is replaced only in sentences that contain the name of a secret. A sentence
    about a secret of the new version says that it is in clear text.
    """
    old, new = (_find_secrets(version, versions) for version in (versions.old, versions.new))
    secrets = old | new
    if not secrets:
        return result
    unmistakable = _make_replacement(secret for secret in secrets if _is_unmistakable(secret))

    def hide(change: Change) -> Change:
        text = " ".join([str(change.sentence), *change.cases])
        present = [secret for secret in secrets if secret in text]
        if not present or (re.search(_NAME, text, re.IGNORECASE) is None and not any(map(_is_unmistakable, present))):
            return change
        replace_secrets = _make_replacement(present)
        sentence: Phrase = change_texts(change.sentence, replace_secrets)
        if str(sentence) != str(change.sentence) and any(secret in new for secret in present) and not _is_old(change):
            sentence = phrase("{change} (a secret in clear text)", change=sentence)
        return replace(change, sentence=sentence, cases=change_texts(change.cases, replace_secrets))

    subjects = [replace(subject, changes=[hide(change) for change in subject.changes]) for subject in result.subjects]
    states = {path: _hide_in_state(state, secrets) for path, state in result.file_states.items()}
    return review_with_texts(replace(result, subjects=subjects, file_states=states), unmistakable)


def _is_old(change: Change) -> bool:
    return change.location is not None and change.location.is_old


def _hide_in_state(state: Phrase, secrets: Iterable[str]) -> Phrase:
    text = str(state)
    has_name = re.search(_NAME, text, re.IGNORECASE) is not None
    return change_texts(state, _make_replacement(item for item in secrets if has_name or _is_unmistakable(item)))


def _make_replacement(secrets: Iterable[str]) -> Callable[[str], str]:
    """Return a function that replaces secrets in a text where they are whole words."""
    words = [re.escape(secret) for secret in sorted(secrets, key=len, reverse=True)]
    if not words:
        return lambda text: text
    pattern = re.compile(rf"(?<![\w])(?:{'|'.join(words)})(?![\w])")
    return lambda text: pattern.sub(_HIDDEN, text)


def _is_unmistakable(secret: str) -> bool:
    """Return whether a text has characters of several classes, so that it is hardly a name or an ordinary word."""
    return sum(pattern.search(secret) is not None for pattern in _CLASSES) >= _MIN_CLASSES


def _find_secrets(version: Version, versions: Versions) -> set[str]:
    """Return the secrets in the changed files of a version, and in its launch and YAML files."""
    paths = {
        file.old_path if version.is_old else file.new_path for file in versions.changed_files if not file.is_submodule
    }
    paths |= {path for path in version.paths(("",)) if path.endswith(_SETTINGS) or is_launch_file(path)}
    return {secret for path in paths if path for secret in find_secrets_in_text(path, version.text(path))}


def find_secrets_in_text(path: str, text: str) -> Iterator[str]:
    """Yield the values of passwords, tokens and the like that a file contains as literal texts."""
    patterns = [*_LITERALS, _PLAIN] if PurePosixPath(path).suffix in _PLAIN_SUFFIXES else [*_LITERALS]
    for pattern in patterns:
        for match in pattern.finditer(text):
            groups = match.groupdict()
            value = (groups.get("value") or groups.get("quote_value") or "").strip()
            if value and _NO_SECRETS.fullmatch(value) is None:
                yield value
