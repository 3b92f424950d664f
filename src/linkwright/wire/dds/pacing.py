"""Send large samples to Fast DDS readers on this machine as fast as these can receive them.

Cyclone sends all packets of a sample at once. A reader of Fast DDS receives into a buffer of 208 kB, so most packets of
an image are lost. A reliable reader requests the lost packets again, which costs milliseconds for every three packets,
and a best-effort reader drops the image. Therefore, this module sends the packets first, one by one, with the GUID and
the sequence number of Cyclone's writer. Then Cyclone writes the sample, and its packets are duplicates for a reader
that already has them. Cyclone still handles discovery, acknowledgments and retransmission
(`docs/decisions/0104-large-messages-packet-by-packet.md`).
"""

from __future__ import annotations

import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from queue import SimpleQueue

from linkwright.wire.dds.local_sockets import count_waiting_bytes
from linkwright.wire.dds.rtps.messages import (
    FRAGMENT_SIZE,
    build_fragment_start,
    build_info_timestamp,
    build_message,
    count_fragments,
)
from linkwright.wire.dds.rtps.values import PREFIX_SIZE, UNKNOWN_ENTITY, Address
from linkwright.wire.guarded_calls import call_guarded

_BUFFER_SIZE = 212_992
"""Bytes of a receive buffer on Linux, unless a process asks for more."""

_PACKET_SIZE = 61_440
"""The bytes that a packet with a full fragment occupies in that buffer, rounded up. Three packets fit."""

_MIN_FREE_PACKETS = 2
"""The number of packets that must fit before sending resumes.

A check after each packet would take longer than sending the packet.
"""

_PAUSE_S = 0.0002
"""Seconds between two checks of a full buffer."""

_MAX_CHECKS = 200
"""The maximum number of these checks for one sample, because a stopped reader never empties its buffer."""

_BLIND_PAUSE_S, _BLIND_PACKETS = 0.0005, 2
"""The pause, in seconds, after each group of packets if the system does not report the bytes in a buffer."""


class Receiver:
    """The receiving socket of another process, and the free space in its buffer.

    Args:
        address: the address of the socket.
        count_waiting: returns the number of bytes waiting at a port; None if the system does not report it.
        pause: sleeps for the given number of seconds.
    """

    def __init__(
        self,
        address: Address,
        count_waiting: Callable[[int], int | None] = count_waiting_bytes,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        self.address = address
        self._waiting = count_waiting
        self._pause = pause
        self._remaining_packets = self._remaining_checks = 0
        self._is_stuck = False

    def begin(self) -> None:
        """Start a new sample.

        If the reader received nothing of the previous sample, `wait_for_room` does not wait for this one.
        """
        self._remaining_packets, self._remaining_checks = 0, 1 if self._is_stuck else _MAX_CHECKS

    def wait_for_room(self) -> bool:
        """Wait until a packet fits into the buffer.

        Returns False if no packet fits before the number of checks for this sample is exhausted.
        """
        if not self._remaining_packets:
            self._remaining_packets = self._count_free_packets()
            self._is_stuck = not self._remaining_packets
        if self._remaining_packets:
            self._remaining_packets -= 1
        return not self._is_stuck

    def _count_free_packets(self) -> int:
        while self._remaining_checks:
            waiting_count = self._waiting(self.address[1])
            if waiting_count is None:
                self._pause(_BLIND_PAUSE_S)
                return _BLIND_PACKETS
            packet_count = (_BUFFER_SIZE - waiting_count) // _PACKET_SIZE
            if packet_count >= _MIN_FREE_PACKETS:
                return packet_count
            self._remaining_checks -= 1
            self._pause(_PAUSE_S)
        return 0


class Pacer:
    """A thread that sends the large samples of all writers of a participant.

    The thread starts with the first sample.

    Args:
        find_address: returns the address of a reader on this machine from the reader's GUID; None if it is not known.
    """

    def __init__(self, find_address: Callable[[bytes], Address | None]) -> None:
        self._find_address = find_address
        self._work: SimpleQueue[PacedWriter | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._socket: socket.socket | None = None
        self._receivers: dict[Address, Receiver] = {}

    def find_addresses(self, readers: Iterable[bytes]) -> dict[bytes, Address]:
        """Return the addresses of the participants of readers on this machine, by GUID prefix."""
        addresses = {reader[:PREFIX_SIZE]: self._find_address(reader) for reader in readers}
        return {prefix: address for prefix, address in addresses.items() if address is not None}

    def add(self, writer: PacedWriter) -> None:
        """Queue a writer whose samples are to be sent.

        Any thread may call this method.
        """
        with self._lock:
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="linkwright-dds-pace", daemon=True)
                self._thread.start()
        self._work.put(writer)

    def stop(self, timeout: float) -> None:
        """End the thread, waiting at most `timeout` seconds."""
        self._work.put(None)
        if self._thread is not None:
            self._thread.join(timeout)
        if self._socket is not None:
            self._socket.close()

    def send(
        self, writer: bytes, sequence_number: int, sample: bytes, published_ns: int, addresses: dict[bytes, Address]
    ) -> None:
        """Send a sample on behalf of a writer.

        Args:
            writer: the writer's GUID.
            sequence_number: the sequence number that the writer assigns to the sample.
            sample: the serialized sample, whose length is a multiple of four bytes.
            published_ns: when the sample was published, in ns since the epoch.
            addresses: the addresses of the participants with readers; see `find_addresses`.
        """
        if self._socket is None:
            self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        stamp, data = build_info_timestamp(published_ns), memoryview(sample)
        readers = {prefix: self._get_receiver(address) for prefix, address in addresses.items()}
        for receiver in readers.values():
            receiver.begin()
        for fragment_number in range(1, count_fragments(sample) + 1):
            fragment = data[(fragment_number - 1) * FRAGMENT_SIZE : fragment_number * FRAGMENT_SIZE]
            start = build_fragment_start(
                UNKNOWN_ENTITY, writer[PREFIX_SIZE:], sequence_number, len(sample), fragment_number, len(fragment)
            )
            for prefix, receiver in tuple(readers.items()):
                if receiver.wait_for_room():
                    head = build_message(writer[:PREFIX_SIZE], stamp, start, to=prefix)
                    with suppress(OSError):  # Cyclone sends the packets that the system refuses here
                        self._socket.sendto(head + fragment, receiver.address)
                else:
                    del readers[prefix]

    def _get_receiver(self, address: Address) -> Receiver:
        receiver = self._receivers.get(address)
        if receiver is None:
            receiver = self._receivers[address] = Receiver(address)
        return receiver

    def _run(self) -> None:
        while (writer := self._work.get()) is not None:
            if call_guarded(writer.send_next) is not False:  # after an error, continue with the next sample
                self._work.put(writer)


class PacedWriter:
    """A writer that keeps its samples in order, and sends large ones to Fast DDS readers first.

    Args:
        guid: the writer's GUID.
        depth: the maximum number of queued samples; newer samples replace the oldest.
        write: writes a sample with its time of publication, in ns since the epoch (None for now); returns whether that
            succeeded. The writer numbers the written samples from 1.
        readers: returns the GUIDs of the readers of Fast DDS that match the writer.
        pacer: sends the large samples.
    """

    def __init__(
        self,
        guid: bytes,
        depth: int,
        write: Callable[[bytes, int | None], bool],
        readers: Callable[[], Iterable[bytes]],
        pacer: Pacer,
    ) -> None:
        self._guid = guid
        self._write = write
        self._readers = readers
        self._pacer = pacer
        self._waiting: deque[tuple[bytes, int]] = deque(maxlen=depth)
        self._written_count = 0
        self._is_pacing = False
        self._is_numbered = True
        self._condition = threading.Condition(threading.RLock())  # reentrant, as in `Backlog`

    def write(self, sample: bytes) -> None:
        """Write a sample immediately, or queue it behind large samples.

        Any thread may call this method.
        """
        with self._condition:
            if not self._is_pacing and not self._find_paced_addresses(sample):
                self._write_now(sample)
                return
            self._waiting.append((sample, time.time_ns()))
            if self._is_pacing:
                return
            self._is_pacing = True
        self._pacer.add(self)

    def send_next(self) -> bool:
        """Send the next queued sample.

        Return False if no sample was queued. Called in the pacer's thread.
        """
        with self._condition:
            if self._waiting:
                sample, published_ns = self._waiting.popleft()
            else:
                self._is_pacing = False
                self._condition.notify_all()
                return False
        addresses = self._find_paced_addresses(sample)
        if addresses:
            self._pacer.send(self._guid, self._written_count + 1, sample, published_ns, addresses)
        if not self._write_now(sample, published_ns) and addresses:
            self._is_numbered = False  # readers have received this number with another sample
        return True

    def wait_until_written(self, seconds: float) -> bool:
        """Wait until no sample is queued.

        Return False if that takes longer than `seconds`.
        """
        with self._condition:
            return self._condition.wait_for(lambda: not self._is_pacing, min(seconds, threading.TIMEOUT_MAX))

    def close(self) -> None:
        """Drop the queued samples."""
        with self._condition:
            self._waiting.clear()

    def _find_paced_addresses(self, sample: bytes) -> dict[bytes, Address]:
        """Return the paced destination addresses of a sample.

        The result is empty if the sample fits into one packet.
        """
        return self._pacer.find_addresses(self._readers()) if len(sample) > FRAGMENT_SIZE and self._is_numbered else {}

    def _write_now(self, sample: bytes, published_ns: int | None = None) -> bool:
        is_written = self._write(sample, published_ns)
        self._written_count += is_written
        return is_written
