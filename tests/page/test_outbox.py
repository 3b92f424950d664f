from __future__ import annotations

import asyncio

from hypothesis import given
from hypothesis import strategies as st

from linkwright.page.outbox import FRAME_TABLE, TRANSFORMS, Outbox, ScaledData


async def emptied(outbox: Outbox) -> list:
    return [await outbox.take() for _ in range(len(outbox))]


async def test_only_the_newest_of_a_kind_waits():
    outbox = Outbox()
    for number in range(5):
        outbox.put("a", f"a{number}")
        outbox.put(TRANSFORMS, bytes([number]))
    outbox.put("b", "b")
    assert len(outbox) == 3
    assert await emptied(outbox) == [bytes([4]), "a4", "b"]


async def test_a_replaced_payload_goes_to_the_end():
    outbox = Outbox()
    for key, payload in (("a", "a1"), ("b", "b1"), ("a", "a2")):
        outbox.put(key, payload)
    assert await emptied(outbox) == ["b1", "a2"]


def scaled(key: str) -> ScaledData:
    return ScaledData(key, key, lambda _: key, str.encode)


async def test_heavy_content_keeps_its_place_so_that_none_starves():
    outbox = Outbox()
    for key in ("a", "b", "c"):
        outbox.put(key, scaled(key))
    newer = scaled("a")
    outbox.put("a", newer)
    assert await outbox.take() is newer


async def test_heavy_content_that_was_taken_away_comes_after_what_said_so():
    outbox = Outbox()
    old, new = scaled("a"), scaled("a")
    outbox.put("a", old)
    old.is_withdrawn = True
    outbox.put("forgotten", "forgotten")
    outbox.put("a", new)
    assert [await outbox.take(), await outbox.take()] == ["forgotten", new]
    outbox.put("a", old)
    outbox.put("b", "b")
    assert await outbox.take() == "b"


async def test_a_held_outbox_gives_transforms_only():
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


async def test_transforms_overtake_but_do_not_starve_the_rest():
    outbox = Outbox()
    for key in ("a", "b", "c"):
        outbox.put(key, key)
    outbox.put(FRAME_TABLE, "table")
    sent = []
    for number in range(6):
        outbox.put(TRANSFORMS, bytes([number]))
        sent.append(await outbox.take())
    assert sent == ["table", "a", bytes([2]), "b", bytes([4]), "c"]


async def test_the_table_goes_before_its_transforms():
    outbox = Outbox()
    outbox.put(FRAME_TABLE, "table")
    outbox.put(TRANSFORMS, b"1")
    assert await emptied(outbox) == ["table", b"1"]


async def test_take_waits_for_something():
    outbox = Outbox()
    taking = asyncio.ensure_future(outbox.take())
    await asyncio.sleep(0)
    assert not taking.done()
    outbox.put("a", "a")
    assert await asyncio.wait_for(taking, 1) == "a"


@given(st.lists(st.tuples(st.sampled_from(["a", "b", FRAME_TABLE, TRANSFORMS]), st.integers())))
def test_the_last_of_every_kind_arrives(puts):
    async def scenario():
        outbox = Outbox()
        for key, number in puts:
            outbox.put(key, f"{key} {number}")
        return await emptied(outbox)

    last = {key: f"{key} {number}" for key, number in puts}
    assert sorted(asyncio.run(scenario())) == sorted(last.values())
