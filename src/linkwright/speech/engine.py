"""The interface of speech recognition engines.

Engines are found through entry points of the group ``linkwright.speech_engines``. Each entry point names a callable
that takes `EngineOptions`, returns a `SpeechEngine`, and raises LinkwrightError if its library or model is missing.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import extensions
from linkwright.speech.sound.samples import Samples

_GROUP = "linkwright.speech_engines"


@dataclass(frozen=True, slots=True)
class Heard:
    """A result of an engine, partial or final.

    Attributes:
        text: one of the phrases of the options; empty for speech that does not match any phrase.
        confidence: the confidence of the least certain word, 0 to 1.
        final: whether the utterance is over; a partial result may still change.
        start: the start of the utterance, in seconds of sound since the engine was created.
        end: the end of the recognized sound, on the same time scale.
        nearest: if the text is empty, the most similar phrase; empty if no phrase is similar.
    """

    text: str
    confidence: float
    final: bool
    start: float
    end: float
    nearest: str = ""


@dataclass(frozen=True, slots=True)
class EngineOptions:
    """The options of an engine.

    Attributes:
        phrases: all phrases to recognize; the engine must not return any other text.
        language: ``en``, ``zh`` or another BCP 47 tag, for engines that depend on the language.
        model: the file or folder of the model, for engines that need one; None for the engine's default.
    """

    phrases: tuple[str, ...]
    language: str = "en"
    model: Path | None = None


class SpeechEngine(ABC):
    """A recognizer of phrases in a stream of sound.

    Only one thread at a time may call it.
    """

    @abstractmethod
    def hear(self, samples: Samples) -> Sequence[Heard]:
        """Process the next samples of the stream, any number, and return new results in order."""

    @abstractmethod
    def finish(self) -> Sequence[Heard]:
        """End the utterance, for example when a button is released, and return its final results.

        More samples may follow.
        """

    @property
    def problem(self) -> Diagnostic | None:
        """The reason why the engine recognizes less than it should, or None if it works fully."""
        return None

    def close(self) -> None:  # noqa: B027 - few engines have resources to release
        """Release the engine's resources.

        No other method is called afterwards.
        """


def engine_names() -> tuple[str, ...]:
    """Return the names of the installed engines."""
    return tuple(extensions(_GROUP))


def make_engine(name: str, options: EngineOptions) -> SpeechEngine:
    """Create an engine by its name.

    Raises:
        LinkwrightError: VOICE101, there is no such engine; VOICE106, the package that provides it cannot be imported;
            or an error of the engine itself.
    """
    entry_point = extensions(_GROUP).get(name)
    if entry_point is None:
        message = phrase("there is no speech engine '{name}'", name=name)
        raise LinkwrightError(Diagnostic("VOICE101", message, hint=did_you_mean(name, engine_names())))
    message = phrase("the speech engine '{name}' cannot be imported", name=name)
    engine: SpeechEngine = load_extension(entry_point, "VOICE106", message)(options)
    return engine
