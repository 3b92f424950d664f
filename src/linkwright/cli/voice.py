"""``linkwright voice``: test speech engines with recordings, and manage enrolled words."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE, print_message
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.output import write_error
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    counted,
    did_you_mean,
    display_path,
    phrase,
)
from linkwright.diagnostics.translation import localized

if TYPE_CHECKING:
    from linkwright.speech.commands.command_set import CommandSet
    from linkwright.speech.engine import Heard, SpeechEngine
    from linkwright.speech.enrolled.words import Words
    from linkwright.speech.sound.samples import Samples

_ENGINE = "enrolled"
_TEST_PHRASES = {"en": "stop", "zh": "停止"}
"""The languages to test engines in, with a phrase for each."""


def configure_try(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``voice try``."""
    parser.add_argument("files", metavar="WAV", nargs="+", help="recordings")
    parser.add_argument(
        "--engine",
        metavar="ENGINE",
        default=_ENGINE,
        help="the engine: enrolled (default), vosk, pocketsphinx, onnx, or another installed engine",
    )
    parser.add_argument("--language", metavar="LANGUAGE", default="en", help="the spoken language: en (default), zh")
    parser.add_argument("--model", metavar="PATH", type=Path, help="a model to use instead of the engine's default")
    parser.add_argument("--commands", metavar="FILE", help="the file of commands (default: the built-in one)")
    parser.add_argument("--partials", action="store_true", help="also print partial results")


def run_try(arguments: argparse.Namespace) -> int:
    """Print the words that a speech engine recognizes in recordings."""
    from linkwright.speech.commands.command_file import DEFAULT_FILE, read_command_file
    from linkwright.speech.engine import EngineOptions, make_engine
    from linkwright.speech.sound.wav import read_wav

    sounds = [read_wav(file) for file in arguments.files]
    commands = read_command_file(arguments.commands or DEFAULT_FILE)
    options = EngineOptions(commands.phrases(arguments.language), arguments.language, arguments.model)
    engine = make_engine(arguments.engine, options)
    trial = _Trial(engine, commands, partials=arguments.partials)
    try:
        for file, samples in zip(arguments.files, sounds, strict=True):
            trial.feed(file, samples)
    finally:
        engine.close()
    return FINE


class _Trial:
    """A trial that feeds recordings to an engine as a microphone does, and prints results.

    Args:
        engine: the speech engine.
        commands: the commands that the results are matched with.
        partials: whether to print partial results.
    """

    def __init__(self, engine: SpeechEngine, commands: CommandSet, *, partials: bool) -> None:
        self._engine, self._commands, self._partials = engine, commands, partials
        self._fed_samples = 0

    def feed(self, file: str, samples: Samples) -> None:
        """Feed a recording to the engine, and print the results, one per line."""
        import numpy as np

        from linkwright.speech.sound.samples import BLOCK_LENGTH, RATE

        recording_start = self._fed_samples / RATE
        sound = np.concatenate((samples, np.zeros(RATE, np.int16)))  # append silence, which ends an utterance
        final_count = 0
        for block_start in range(0, len(sound), BLOCK_LENGTH):
            block = sound[block_start : block_start + BLOCK_LENGTH]
            self._fed_samples += len(block)
            computation_start = time.perf_counter()
            results = self._engine.hear(block)
            final_count += self._print_results(
                file, results, recording_start, self._fed_samples / RATE + time.perf_counter() - computation_start
            )
        computation_start = time.perf_counter()
        results = self._engine.finish()
        final_count += self._print_results(
            file, results, recording_start, self._fed_samples / RATE + time.perf_counter() - computation_start
        )
        if not final_count:
            print(localized(phrase("{file}: nothing recognized", file=file)))

    def _print_results(self, file: str, results: Sequence[Heard], recording_start: float, current_time: float) -> int:
        """Print results, and return how many of them are final.

        Args:
            file: the name of the recording.
            results: the results of one block.
            recording_start: the time at which the recording begins, in seconds since the first recording began.
            current_time: the time of the print on the same scale, which includes the time of computation.
        """
        for result in results:
            if result.final or self._partials:
                times = {
                    "start": f"{max(0.0, result.start - recording_start):.2f}",
                    "end": f"{result.end - recording_start:.2f}",
                }
                print(localized(phrase(
                    "{file}: {result}, {start} s to {end} s, recognized {latency} s later",
                    file=file, result=self._format_result(result), latency=f"{max(0.0, current_time - result.end):.2f}",
                    **times,
                )))  # fmt: skip
        return sum(result.final for result in results)

    def _format_result(self, result: Heard) -> Phrase:
        if not result.text:
            return phrase("none of the phrases")
        values = {"text": result.text, "confidence": f"{result.confidence:.2f}"}
        if not result.final:
            return phrase("partial: '{text}' ({confidence})", **values)
        match = self._commands.match_command(result.text)
        if match is None:
            return phrase("'{text}' ({confidence}), no command", **values)
        return phrase("'{text}' ({confidence}), command {intent}", intent=match.command.intent, **values)


def configure_enroll(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``voice enroll``."""
    parser.add_argument("word", metavar="WORD", help="the word or phrase, as in the commands")
    parser.add_argument(
        "files", metavar="WAV", nargs="+", help="recordings that each contain the word once; three are best"
    )
    _add_file_argument(parser)


def run_enroll(arguments: argparse.Namespace) -> int:
    """Enroll a word from recordings, but only if all of them are usable."""
    from linkwright.speech.enrolled.enrollment import enroll
    from linkwright.speech.enrolled.words import RECOMMENDED_TAKES
    from linkwright.speech.sound.wav import read_wav

    path = _find_words_path(arguments)
    words = _read_words(path)
    diagnostics: list[Diagnostic] = []
    for file in arguments.files:
        note = Note(phrase("in '{path}'", path=file))
        new_diagnostics = enroll(words, arguments.word, read_wav(file))
        diagnostics += [diagnostic.with_changes(notes=(*diagnostic.notes, note)) for diagnostic in new_diagnostics]
    if diagnostics:
        raise LinkwrightError(*diagnostics)
    _write_words(words, path)
    count = len(words.takes(arguments.word))
    recordings = counted("{count} recording", "{count} recordings", count)
    print(localized(phrase("'{word}': {recordings}", word=arguments.word, recordings=recordings)))
    if count < RECOMMENDED_TAKES:
        print_message(
            localized(phrase("{count} recordings make the recognition more reliable", count=RECOMMENDED_TAKES))
        )
    return FINE


def configure_words(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``voice words``."""
    _add_file_argument(parser)


def run_words(arguments: argparse.Namespace) -> int:
    """Print the enrolled words."""
    path = _find_words_path(arguments)
    words = _read_words(path)
    for name in words.names:
        recordings = counted("{count} recording", "{count} recordings", len(words.takes(name)))
        print(localized(phrase("'{word}': {recordings}", word=name, recordings=recordings)))
    if not words.names:
        print_message(localized(phrase("no word is enrolled in '{path}'", path=display_path(path))))
    return FINE


def configure_forget(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``voice forget``."""
    parser.add_argument("word", metavar="WORD", help="the word, as `linkwright voice words` prints it")
    _add_file_argument(parser)


def run_forget(arguments: argparse.Namespace) -> int:
    """Remove an enrolled word."""
    path = _find_words_path(arguments)
    words = _read_words(path)
    if arguments.word not in words.names:
        message = phrase("the word '{word}' is not enrolled", word=arguments.word)
        raise LinkwrightError(Diagnostic("VOICE210", message, hint=did_you_mean(arguments.word, words.names)))
    words.remove(arguments.word)
    _write_words(words, path)
    print(localized(phrase("Removed {path}", path=arguments.word)))
    return FINE


def configure_engines(parser: argparse.ArgumentParser) -> None:
    """Declare nothing, because ``voice engines`` does not take arguments."""


def run_engines(_: argparse.Namespace) -> int:
    """Create each speech engine in each language, and print the reason for each failure."""
    from linkwright.speech.engine import engine_names

    for name in engine_names():
        for language, text in _TEST_PHRASES.items():
            print(f"{name} {language}: {localized(_format_engine_status(name, language, text))}")
    return FINE


def _format_engine_status(name: str, language: str, text: str) -> Phrase:
    from linkwright.speech.engine import EngineOptions, make_engine

    try:
        make_engine(name, EngineOptions((text,), language)).close()
    except LinkwrightError as error:
        (first_line, *_) = error.diagnostics
        return (
            phrase("{problem}; {hint}", problem=first_line.message, hint=first_line.hint)
            if first_line.hint
            else first_line.message
        )
    return phrase("ready")


def _add_file_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--file", metavar="FILE", type=Path, help="the file of enrolled words to use instead of the user's own"
    )


def _find_words_path(arguments: argparse.Namespace) -> Path:
    from linkwright.speech.enrolled.words import find_words_path

    path: Path | None = arguments.file
    return path or find_words_path()


def _read_words(path: Path) -> Words:
    from linkwright.speech.enrolled.words import Words

    return Words.read(path) if path.exists() else Words()


def _write_words(words: Words, path: Path) -> None:
    try:
        words.write(path)
    except OSError as error:
        raise write_error(path, error) from None


VERBS = {
    "try": SubVerb(configure_try, run_try, help="print the words and commands that an engine recognizes in recordings"),
    "enroll": SubVerb(configure_enroll, run_enroll, help="enroll a word from recordings of it"),
    "words": SubVerb(configure_words, run_words, help="list the enrolled words"),
    "forget": SubVerb(configure_forget, run_forget, help="remove an enrolled word"),
    "engines": SubVerb(configure_engines, run_engines, help="list the engines and their missing requirements"),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``voice``."""
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    return run_nested(arguments)
