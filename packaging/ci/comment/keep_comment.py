"""Keep the comment of `linkwright review` on a pull request up to date: on GitHub, Gitea, Forgejo and GitLab.

The program needs Python and nothing else, so that a job with a token that can write installs nothing. It takes the
address of the service and the event from the variables of the job, and the token from LINKWRIGHT_TOKEN.

    keep_comment.py pull-request FOLDER [LINK]   on the pull request (GitLab: merge request) of the job; FOLDER has the
                                                 files of the review, and LINK leads to them
    keep_comment.py workflow-run ARTIFACT        on the pull request of a fork, whose run uploaded the files

Files of a fork's run are untrusted, see `comment_of_run`. docs/decisions/0136 has the reasons.
"""

from __future__ import annotations

import html
import io
import json
import os
import re
import sys
import time
import urllib.error
import urllib.parse
import urllib.request
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MARKER = "<!-- linkwright review -->"
"""The first line of a comment; see ``linkwright/review/reports/markdown.py``."""
COMMENT, REPORT, NUMBER = "comment.md", "report.json", "pull-request.txt"
"""The files of a review that the program reads."""
MAX_COMMENT = 65_000
"""The number of characters of a comment. GitHub refuses more than 65 536."""
MAX_REPORT = 32_000_000
MAX_ARTIFACT = 256_000_000
"""The number of bytes of an artifact, which also has images."""
_TIMEOUT = 30.0
_TRIES = 3
_PAGE_SIZE = 100
_REDIRECTS = (301, 302, 303, 307, 308)
_DENIED = (401, 403)
_TEMPORARY = (429, 500, 502, 503, 504)
_ACTIONS_USERS = ("gitea-actions", "forgejo-actions")
"""The authors of comments that are written with the token of a job of Gitea or Forgejo."""

_TAGS = re.compile(r"</?(?:details|summary|code)>")
_NOT_ESCAPED = re.compile(r"[<\[\]`\\]")
_MENTION = re.compile(r"[@#](?=\w)")
_ADDRESS = re.compile(r"(://|\bwww\.)(?=\S)", re.IGNORECASE)


class NotPosted(Exception):  # noqa: N818 - some reasons are no errors
    """The reason why there is no comment.

    Attributes:
        is_error: whether the job fails.
    """

    def __init__(self, reason: str, *, is_error: bool = False) -> None:
        super().__init__(reason)
        self.is_error = is_error


# --- the service ----------------------------------------------------------------------------------------------------


class _NoRedirect(urllib.request.HTTPRedirectHandler):
    """Follow no redirect, because the new request would carry the token to another server."""

    def redirect_request(self, *_: Any) -> None:
        return None


@dataclass(frozen=True)
class Api:
    """The REST API of a service.

    Attributes:
        url: the address, without a slash at its end.
        headers: the headers with the token.
    """

    url: str
    headers: Mapping[str, str]

    def call(self, method: str, path: str, values: Mapping[str, object] | None = None) -> Any:
        """Return the response, parsed from JSON.

        Raises:
            urllib.error.HTTPError: the service refuses the request.
        """
        body = None if values is None else json.dumps(values).encode()
        headers = {**self.headers, "Accept": "application/json", "Content-Type": "application/json"}
        status, data, location = _open(f"{self.url}/{path}", method, headers, body)
        if location:
            raise NotPosted(f"the service answers {status} to {method} {path}: it is elsewhere now", is_error=True)
        return json.loads(data or b"null")

    def pages(self, path: str) -> Iterator[Any]:
        """Yield the items of all pages of a list. Gitea returns all of them on every page."""
        seen: set[object] = set()
        page = 1
        while True:
            items = self.call("GET", f"{path}?per_page={_PAGE_SIZE}&page={page}")
            new_items = [item for item in items if item["id"] not in seen]
            yield from new_items
            seen.update(item["id"] for item in items)
            page += 1
            if len(items) < _PAGE_SIZE or not new_items:
                return

    def download(self, path: str, limit: int) -> bytes:
        """Return a file, which may be on another server, to which the token is not sent."""
        _, data, location = _open(f"{self.url}/{path}", "GET", self.headers, limit=limit)
        if location:
            _, data, _ = _open(urllib.parse.urljoin(self.url, location), "GET", {}, limit=limit)
        return data


def _open(
    url: str, method: str, headers: Mapping[str, str], body: bytes | None = None, limit: int = MAX_REPORT
) -> tuple[int, bytes, str]:
    """Return the status, the content, and the target of a redirect or an empty string.

    Reading is tried again after temporary errors; writing is not, because that could write a second comment.
    """
    if urllib.parse.urlsplit(url).scheme not in ("http", "https"):
        raise NotPosted(f"the address of the service is not one of the web: {url}", is_error=True)
    opener = urllib.request.build_opener(_NoRedirect)
    for attempt in range(_TRIES if method == "GET" else 1):
        if attempt:
            time.sleep(attempt)
        is_last = method != "GET" or attempt == _TRIES - 1
        request = urllib.request.Request(url, body, dict(headers), method=method)  # noqa: S310 - the scheme is checked
        try:
            with opener.open(request, timeout=_TIMEOUT) as response:
                data = response.read(limit + 1)
        except urllib.error.HTTPError as error:
            location = error.headers.get("Location") if error.code in _REDIRECTS else None
            if location:
                return error.code, b"", location
            if is_last or error.code not in _TEMPORARY:
                raise
            continue
        except OSError:
            if is_last:
                raise
            continue
        if len(data) > limit:
            raise NotPosted(f"the service sends more than {limit} bytes", is_error=True)
        return response.status, data, ""
    raise AssertionError


@dataclass(frozen=True)
class Thread:
    """The comments of a pull request.

    Attributes:
        api: the API.
        comments: the path of the list of comments.
        comment: the path of a comment without its number.
        edit_method: the method that edits a comment.
        author_key: the key of a comment's author.
        name_key: the key of the author's name.
    """

    api: Api
    comments: str
    comment: str
    edit_method: str = "PATCH"
    author_key: str = "user"
    name_key: str = "login"

    def keep(self, text: str, *, is_empty: bool) -> str:
        """Write the comment or edit the one that exists, and return what was done.

        Raises:
            NotPosted: nothing is to be posted, or the token cannot write.
        """
        own = self._own_comment()
        if own is None and is_empty:
            return "the review has nothing to say, and there is no comment to update"
        if own is not None and own["body"].splitlines() == text.splitlines():
            return "the comment is up to date"
        try:
            if own is None:
                self.api.call("POST", self.comments, {"body": text})
                return "the comment is posted"
            self.api.call(self.edit_method, f"{self.comment}/{own['id']}", {"body": text})
        except urllib.error.HTTPError as error:
            if error.code in _DENIED:
                raise NotPosted(
                    "this job's token cannot comment, as in pull requests of forks; the report is in the summary and "
                    "the files of the job, and docs/howto-review.md says how the comment gets there"
                ) from None
            raise
        return "the comment is updated"

    def _own_comment(self) -> dict[str, Any] | None:
        """Return the comment to update. Others can write the marker, but their comments are not edited."""
        is_own: Callable[[Any], bool] | None = None
        for comment in self.api.pages(self.comments):
            if comment["body"].partition("\n")[0].strip() == MARKER:
                is_own = is_own or self._author_check()
                if is_own(comment[self.author_key]):
                    return dict(comment)
        return None

    def _author_check(self) -> Callable[[Any], bool]:
        """Return whether an author is the owner of the token; tokens of jobs may not ask who that is."""
        try:
            name = self.api.call("GET", "user")[self.name_key]
        except urllib.error.HTTPError:
            return lambda author: author.get("type") == "Bot" or author[self.name_key] in _ACTIONS_USERS
        return lambda author: bool(author[self.name_key] == name)


def _actions_api(variables: Mapping[str, str]) -> Api:
    """Return the API of GitHub, Gitea or Forgejo, which all accept the token in this form."""
    return Api(variables["GITHUB_API_URL"].rstrip("/"), {"Authorization": f"token {_token(variables)}"})


def _token(variables: Mapping[str, str]) -> str:
    token = variables.get("LINKWRIGHT_TOKEN", "").strip()
    if not token:
        raise NotPosted("there is no comment, because the variable LINKWRIGHT_TOKEN is not set")
    return token


def _pull_request(variables: Mapping[str, str], number: int) -> Thread:
    issues = f"repos/{variables['GITHUB_REPOSITORY']}/issues"
    return Thread(_actions_api(variables), f"{issues}/{number}/comments", f"{issues}/comments")


def _merge_request(variables: Mapping[str, str]) -> Thread:
    project, number = variables["CI_MERGE_REQUEST_PROJECT_ID"], variables["CI_MERGE_REQUEST_IID"]
    notes = f"projects/{int(project)}/merge_requests/{int(number)}/notes"
    api = Api(variables["CI_API_V4_URL"].rstrip("/"), {"PRIVATE-TOKEN": _token(variables)})
    return Thread(api, notes, notes, "PUT", "author", "username")


# --- the text -------------------------------------------------------------------------------------------------------


def with_link(text: str, link: str) -> str:
    """Return a comment with a link to the files of the review at its end."""
    return f"{text.rstrip()}\n\n[report.html]({link})\n" if link else text


def is_empty(report: bytes) -> bool:
    """Return whether a review has nothing to say: no change of a robot, no finding and no note."""
    data = json.loads(report)
    if not isinstance(data, dict):
        raise ValueError("the report is not an object")  # noqa: TRY004 - the file is wrong, not the program
    return not any(data.get(key) for key in ("subjects", "new_findings", "fixed_findings", "notes"))


def as_untrusted(text: str, link: str) -> str:
    """Return a comment that a fork's run made, in a form that addresses nobody and links to nothing but the run.

    Reports escape all that can be markup, a mention or a link, so that a text with one is not a report. The line about
    the fork precedes the report, because a report could fold what follows it.

    Raises:
        NotPosted: the text is not a report.
    """
    first, _, rest = text.partition("\n")
    is_report = first == MARKER and len(text) <= MAX_COMMENT and not _NOT_ESCAPED.search(_TAGS.sub("", rest))
    if not is_report or _MENTION.search(html.unescape(rest)):
        raise NotPosted("the comment in the artifact is not a report of a review, and is not posted", is_error=True)
    line = f"> This report comes from [a run of the fork]({link}), whose author can change it."
    return f"{MARKER}\n{line}\n\n" + _ADDRESS.sub("\\1\u200b", rest)


# --- the commands ---------------------------------------------------------------------------------------------------


def comment_of_job(variables: Mapping[str, str], folder: Path, link: str) -> str:
    """Keep the comment on the pull request of the job, and return what was done."""
    text = with_link((folder / COMMENT).read_text(encoding="utf-8"), link)
    if "CI_MERGE_REQUEST_IID" in variables:
        thread = _merge_request(variables)
    else:
        thread = _pull_request(variables, int(_event(variables)["pull_request"]["number"]))
    return thread.keep(text, is_empty=is_empty((folder / REPORT).read_bytes()))


def comment_of_run(variables: Mapping[str, str], name: str) -> str:
    """Keep the comment on the pull request of a fork, whose run uploaded an artifact, and return what was done.

    The run is the fork's: it may have uploaded anything. Of the artifact, three files are read, none is written to
    disk, and the pull request that it names must be one from the commit and the repository of the run.
    """
    event = _event(variables)
    run, repository = event["workflow_run"], event["repository"]
    if run["event"] != "pull_request" or (run["head_repository"] or {}).get("id") in (None, repository["id"]):
        return "the run is not one of a fork's pull request; its own job comments"
    api = _actions_api(variables)
    files = _files_of_artifact(api, variables["GITHUB_REPOSITORY"], int(run["id"]), name)
    number = re.fullmatch(rb"([1-9][0-9]{0,8})\s*", files[NUMBER])
    if number is None:
        raise NotPosted("the artifact does not name a pull request", is_error=True)
    pull = api.call("GET", f"repos/{variables['GITHUB_REPOSITORY']}/pulls/{int(number[1])}")
    if (pull["head"]["repo"] or {}).get("id") != run["head_repository"]["id"]:
        raise NotPosted("the pull request that the artifact names is not one of the fork", is_error=True)
    if pull["state"] != "open" or pull["head"]["sha"] != run["head_sha"]:
        return "the pull request is closed or has newer commits; nothing is posted"
    text = as_untrusted(files[COMMENT].decode("utf-8"), run["html_url"])
    return _pull_request(variables, int(number[1])).keep(text, is_empty=is_empty(files[REPORT]))


def _files_of_artifact(api: Api, repository: str, run: int, name: str) -> dict[str, bytes]:
    """Return the files of an artifact that the program reads."""
    found = api.call("GET", f"repos/{repository}/actions/runs/{run}/artifacts?name={urllib.parse.quote(name)}")
    artifacts = [item for item in found["artifacts"] if item["name"] == name and not item["expired"]]
    if not artifacts:
        raise NotPosted(f"the run has no artifact '{name}'")
    newest = max(artifacts, key=lambda item: int(item["id"]))
    data = api.download(f"repos/{repository}/actions/artifacts/{int(newest['id'])}/zip", MAX_ARTIFACT)
    limits = {COMMENT: 4 * MAX_COMMENT, REPORT: MAX_REPORT, NUMBER: 16}
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {file: _member(archive, file, limit) for file, limit in limits.items()}


def _member(archive: zipfile.ZipFile, name: str, limit: int) -> bytes:
    with archive.open(name) as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise NotPosted(f"'{name}' in the artifact has more than {limit} bytes", is_error=True)
    return data


def _event(variables: Mapping[str, str]) -> dict[str, Any]:
    return dict(json.loads(Path(variables["GITHUB_EVENT_PATH"]).read_bytes()))


_BAD_ARTIFACT = (zipfile.BadZipFile, zlib.error, KeyError, ValueError, RuntimeError, EOFError)
"""The exceptions for an artifact, a report or an event with other contents."""


def main(words: list[str], variables: Mapping[str, str]) -> int:
    """Run a command, print one line, and return the exit status."""
    commands: dict[str, Callable[..., str]] = {
        "pull-request": lambda folder, link="": comment_of_job(variables, Path(folder), link),
        "workflow-run": lambda artifact: comment_of_run(variables, artifact),
    }
    is_error = False
    try:
        line = commands[words[0]](*words[1:])
    except NotPosted as reason:
        line, is_error = str(reason), reason.is_error
    except urllib.error.HTTPError as error:
        path = urllib.parse.urlsplit(error.url or "").path
        line, is_error = f"the comment is not posted: {path} answers {error.code} {error.reason}", True
    except OSError as error:
        line, is_error = f"the comment is not posted: {error}", True
    except _BAD_ARTIFACT as error:
        line, is_error = f"the comment is not posted, because a file is not one of a review: {error}", True
    level = "error" if is_error else "notice"
    line = " ".join(line.split())
    print(f"::{level}::{line}" if "GITHUB_ACTIONS" in variables else line)
    return 1 if is_error else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], os.environ))
