"""Edit files at random, and check that the memory of the language server does not grow.

Usage: ``python -m benchmarks.soak_editor [--minutes 60] [FOLDER]``

A client opens the descriptions of the folder, edits and restores them, and sends requests of each kind. The table shows
the memory and the response times of ``linkwright lsp``. The exit status is 1 if the memory grows after the warm-up, if
the server ends, or if a response takes longer than a limit.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import shutil
import statistics
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import psutil
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient

from benchmarks.measure import ROOT

_FILE_SUFFIXES = (
    ".xacro",
    ".urdf",
    ".sdf",
    ".world",
    ".launch.py",
    ".launch.xml",
    ".yaml",
    ".rviz",
    ".srdf",
    "package.xml",
)
_OPEN_FILES = 12
_EDITS_PER_REQUEST = 3
_WARM_UP_SHARE = 0.25
_MAX_GROWTH_MB = 10.0
_MAX_GROWTH_SHARE = 0.1
_MAX_RESPONSE_S = 30.0
"""The maximum time of a response, in seconds."""

_REFUSAL_CODES = (types.LSPErrorCodes.ContentModified, types.LSPErrorCodes.RequestFailed)
"""The codes of errors that count as responses, such as that a file has changed meanwhile."""

_TEXT_PIECES = (
    "<link",
    "/>",
    '"',
    "${",
    "}",
    "</joint>",
    "<!--",
    "a",
    "1",
    "\n",
    "机器人",
    "🤖",
    "&",
    "- ",
    ": ",
    "$(find ",
)
_AT_POSITION = {
    types.TEXT_DOCUMENT_COMPLETION: types.CompletionParams,
    types.TEXT_DOCUMENT_HOVER: types.HoverParams,
    types.TEXT_DOCUMENT_DEFINITION: types.DefinitionParams,
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT: types.DocumentHighlightParams,
    types.TEXT_DOCUMENT_PREPARE_RENAME: types.PrepareRenameParams,
    types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY: types.CallHierarchyPrepareParams,
}
_OF_DOCUMENT = {
    types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: types.DocumentSymbolParams,
    types.TEXT_DOCUMENT_FOLDING_RANGE: types.FoldingRangeParams,
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: types.SemanticTokensParams,
    types.TEXT_DOCUMENT_CODE_LENS: types.CodeLensParams,
    types.TEXT_DOCUMENT_DOCUMENT_LINK: types.DocumentLinkParams,
    types.TEXT_DOCUMENT_DOCUMENT_COLOR: types.DocumentColorParams,
}


class RandomEditor:
    """A client that edits random files.

    Args:
        client: its connection to a server.
        files: the files that it opens.
        seed: the seed of all choices.
    """

    def __init__(self, client: LanguageClient, files: list[Path], seed: int) -> None:
        self._client, self._files = client, files
        self._random = random.Random(seed)
        self._texts: dict[Path, str] = {}
        self._version = 0
        self.edits = 0
        self.errors: Counter[str] = Counter()
        self.seconds: list[float] = []

    async def step(self) -> None:
        """Open, close, edit or restore a file, and sometimes send a request."""
        if len(self._texts) < _OPEN_FILES or self._random.random() < 0.01:
            self._open(self._random.choice(self._files))
        if len(self._texts) > _OPEN_FILES:
            self._close(self._random.choice([*self._texts]))
        file = self._random.choice([*self._texts])
        self._edit(file)
        if self._random.random() < 1 / _EDITS_PER_REQUEST:
            await self._request(file)

    def _open(self, file: Path) -> None:
        if file not in self._texts:
            self._texts[file] = file.read_text(encoding="utf-8", errors="replace")
            item = types.TextDocumentItem(file.as_uri(), "xml", 0, self._texts[file])
            self._client.text_document_did_open(types.DidOpenTextDocumentParams(item))

    def _close(self, file: Path) -> None:
        del self._texts[file]
        document = types.TextDocumentIdentifier(file.as_uri())
        self._client.text_document_did_close(types.DidCloseTextDocumentParams(document))

    def _edit(self, file: Path) -> None:
        text, choice = self._texts[file], self._random.random()
        offset = self._random.randrange(len(text) + 1)
        if choice < 0.6:
            text = text[:offset] + self._random.choice(_TEXT_PIECES) + text[offset:]
        elif choice < 0.85:
            text = text[:offset] + text[offset + self._random.randrange(1, 30) :]
        else:
            text = file.read_text(encoding="utf-8", errors="replace")
        self._texts[file] = text
        self._version += 1
        self.edits += 1
        document = types.VersionedTextDocumentIdentifier(self._version, file.as_uri())
        change = types.TextDocumentContentChangeWholeDocument(text)
        self._client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))

    async def _request(self, file: Path) -> None:
        document = types.TextDocumentIdentifier(file.as_uri())
        lines = self._texts[file].split("\n")
        line = self._random.randrange(len(lines))
        position = types.Position(line, self._random.randrange(len(lines[line]) + 1))
        method = self._random.choice([*_AT_POSITION, *_OF_DOCUMENT])
        at_position = _AT_POSITION.get(method)
        parameters = at_position(document, position) if at_position else _OF_DOCUMENT[method](document)
        begin = time.monotonic()
        try:
            await asyncio.wait_for(self._client.protocol.send_request_async(method, parameters), 2 * _MAX_RESPONSE_S)
        except JsonRpcException as error:
            if error.code not in _REFUSAL_CODES:
                self.errors[f"{method}: {error.message}"] += 1
        self.seconds.append(time.monotonic() - begin)


async def run(folder: Path, files: list[Path], seconds: float, seed: int) -> list[str]:
    """Edit the files of a folder for some time, print the memory, and return what is wrong."""
    client = LanguageClient("soak", "1")
    client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda _: None)
    await client.start_io(sys.executable, "-m", "linkwright", "lsp")
    workspace = [types.WorkspaceFolder(folder.as_uri(), folder.name)]
    await client.initialize_async(types.InitializeParams(types.ClientCapabilities(), workspace_folders=workspace))
    client.initialized(types.InitializedParams())
    (server,) = psutil.Process().children()
    typist = RandomEditor(client, files, seed)
    begin = shown = time.monotonic()
    samples: list[tuple[float, float]] = []
    print(f"{len(files)} files\n seconds    edits   MB", flush=True)
    while (passed := time.monotonic() - begin) < seconds:
        if not server.is_running():
            return ["the server has ended"]
        await typist.step()
        samples.append((passed, server.memory_info().rss / 1e6))
        if time.monotonic() - shown >= seconds / 20:
            shown = time.monotonic()
            print(f"{passed:8.0f} {typist.edits:8} {samples[-1][1]:4.0f}", flush=True)
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()
    warm = [memory for at, memory in samples if _WARM_UP_SHARE <= at / seconds < 2 * _WARM_UP_SHARE]
    last = [memory for at, memory in samples if at / seconds >= 1 - _WARM_UP_SHARE]
    start_memory, end_memory = statistics.median(warm), statistics.median(last)
    slowest, middle = max(typist.seconds), statistics.median(typist.seconds)
    print(f"memory: {start_memory:.0f} MB after the warm-up, {end_memory:.0f} MB at the end")
    print(f"answers: {len(typist.seconds)}, median {1000 * middle:.0f} ms, slowest {1000 * slowest:.0f} ms")
    faults = [f"{count} times {error}" for error, count in typist.errors.most_common()]
    if end_memory - start_memory > max(_MAX_GROWTH_MB, _MAX_GROWTH_SHARE * start_memory):
        faults.append(f"the memory has grown by {end_memory - start_memory:.0f} MB")
    if slowest > _MAX_RESPONSE_S:
        faults.append(f"an answer took {slowest:.1f} s")
    return faults


def main() -> int:
    """Run the program, and return its exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition(":")[2])
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "tests", help="a folder with packages")
    parser.add_argument("--minutes", type=float, default=60.0, help="how long it runs (default: 60)")
    parser.add_argument("--seed", type=int, default=1, help="the seed of all choices")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as copies:
        folder = Path(copies, "packages")
        shutil.copytree(arguments.folder, folder, symlinks=True)
        files = sorted(path for path in folder.rglob("*") if path.name.endswith(_FILE_SUFFIXES) and path.is_file())
        faults = asyncio.run(run(folder, files, 60 * arguments.minutes, arguments.seed))
    for fault in faults:
        print(f"fault: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
