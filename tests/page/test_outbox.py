"""The outbox of a page: replaced payloads, order and held content."""

from __future__ import annotations

import asyncio

from hypothesis import given
from hypothesis import strategies as st

from linkwright.page.outbox import FRAME_TABLE, TRANSFORMS, Outbox, ScaledData


async def drain_outbox(outbox: Outbox) -> list:
    return [await outbox.take() for _ in range(len(outbox))]


async def test_only_newest_payload_per_key_is_kept():
    outbox = Outbox()
    for number in range(5):
        outbox.put("a", f"a{number}")
        outbox.put(TRANSFORMS, bytes([number]))
    outbox.put("b", "b")
    assert len(outbox) == 3
    assert await drain_outbox(outbox) == [bytes([4]), "a4", "b"]


async def test_replaced_payload_moves_to_end():
    outbox = Outbox()
    for key, payload in (("a", "a1"), ("b", "b1"), ("a", "a2")):
        outbox.put(key, payload)
    assert await drain_outbox(outbox) == ["b1", "a2"]


def scaled_data(key: str) -> ScaledData:
    return ScaledData(key, key, lambda _: key, str.encode)


async def test_replaced_heavy_content_keeps_its_place():
    outbox = Outbox()
    for key in ("a", "b", "c"):
        outbox.put(key, scaled_data(key))
    newer = scaled_data("a")
    outbox.put("a", newer)
    assert await outbox.take() is newer


async def test_withdrawn_heavy_content_moves_to_end():
    outbox = Outbox()
    old, new = scaled_data("a"), scaled_data("a")
    outbox.put("a", old)
    old.is_withdrawn = True
    outbox.put("forgotten", "forgotten")
    outbox.put("a", new)
    assert [await outbox.take(), await outbox.take()] == ["forgotten", new]
    outbox.put("a", old)
    outbox.put("b", "b")
    assert await outbox.take() == "b"


async def test_held_outbox_returns_transforms_only():
    outbox = Outbox()
    outbox.put("a", "a")
    outbox.hold(True)
    taking = asyncio.ensure_future(outbox.take())
    await asyncio.sleep(0)
    outbox.put(TRANSFORMS, b"1")
    assert await asyncio.wait_for(taking, 1) == b"1"
    outbox.put(TRANSFORMS, b"2")
    assert await outbox.take() == b"2"
    outbox.hold(False)
    assert await outbox.take() == "a"


async def test_transforms_take_precedence_without_starving_others():
    outbox = Outbox()
    for key in ("a", "b", "c"):
        outbox.put(key, key)
    outbox.put(FRAME_TABLE, "table")
    sent = []
    for number in range(6):
        outbox.put(TRANSFORMS, bytes([number]))
        sent.append(await outbox.take())
    assert sent == ["table", "a", bytes([2]), "b", bytes([4]), "c"]


async def test_frame_table_precedes_its_transforms():
    outbox = Outbox()
    outbox.put(FRAME_TABLE, "table")
    outbox.put(TRANSFORMS, b"1")
    assert await drain_outbox(outbox) == ["table", b"1"]


async def test_take_waits_for_payload():
    outbox = Outbox()
    taking = asyncio.ensure_future(outbox.take())
    await asyncio.sleep(0)
    assert not taking.done()
    outbox.put("a", "a")
    assert await asyncio.wait_for(taking, 1) == "a"


@given(st.lists(st.tuples(st.sampled_from(["a", "b", FRAME_TABLE, TRANSFORMS]), st.integers())))
def test_last_payload_of_every_key_arrives(puts):
    async def scenario():
        outbox = Outbox()
        for key, number in puts:
            outbox.put(key, f"{key} {number}")
        return await drain_outbox(outbox)

    last = {key: f"{key} {number}" for key, number in puts}
    assert sorted(asyncio.run(scenario())) == sorted(last.values())
