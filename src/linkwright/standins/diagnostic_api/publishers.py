"""Tasks that check what is published on a topic (API of ``diagnostic_updater``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.time.values import Time
from linkwright.standins.diagnostic_api.tasks import (
    FrequencyStatus,
    FrequencyStatusParam,
    TimeStampStatus,
    TimeStampStatusParam,
)
from linkwright.standins.diagnostic_api.updater import CompositeDiagnosticTask, DiagnosticTaskVector


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """A task that checks the frequency of a topic whose messages have no timestamp.

    Args:
        name: the name of the topic.
        diag: the updater to which the task is added.
        freq: the bounds of the frequency.
    """

    def __init__(self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq)
        self.addTask(self.freq)
        self.diag.add(self)

    def tick(self) -> None:
        """Count a message."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Forget all messages."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """A task that checks the frequency of a topic and the age of its messages.

    Args:
        name: the name of the topic.
        diag: the updater to which the task is added.
        freq: the bounds of the frequency.
        stamp: the bounds of the age.
    """

    def __init__(
        self, name: str, diag: DiagnosticTaskVector, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: Any) -> None:  # type: ignore[override]  # as in diagnostic_updater
        """Record a message with this timestamp, a `Time` or seconds as a float."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """A publisher whose messages are checked.

    Args:
        pub: the publisher.
        diag: the updater to which the task is added.
        freq: the bounds of the frequency.
        stamp: the bounds of the age.
    """

    def __init__(
        self, pub: Any, diag: DiagnosticTaskVector, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Record and publish a message that has a header."""
        self.tick(Time.from_msg(message.header.stamp))
        self.publisher.publish(message)
